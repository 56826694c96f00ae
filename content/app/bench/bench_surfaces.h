#pragma once

#include "content/app/bench/bench_report.h"
#include "ecs/base/result.h"
#include "ecs/components/surface.h"

#include <string>
#include <vector>

namespace limn {

struct BenchOptions;
struct HeadlessRenderer;
struct Stage;

// What `limn bench surfaces` prints: what each rung of SurfaceDetail costs on the same wall, which
// fills the image at an oblique angle.

inline constexpr const char* kSurfacesScene = "temple";

/// The wall with one kind of detail.
struct SurfaceBenchPoint {
    std::string name = {};
    SurfaceDetail detail = SurfaceDetail::Flat;
    BenchReport report = {};
};

struct SurfaceBench {
    BenchReport machine = {};  ///< shared by all points: scene, size, threads, OpenGL; no series
    std::vector<SurfaceBenchPoint> points = {};  ///< the first is flat
};

/// Medians of a point [ms].
struct SurfaceCost {
    double frame = 0;    ///< processor time of all threads
    double gbuffer = 0;  ///< of the pass that draws the wall
    double ratio = 0;    ///< of `frame` to that of the flat wall
};

/// From cheap to true.
[[nodiscard]] std::vector<SurfaceBenchPoint> surface_points();

/// Leaves nothing but the wall and its lights before the camera, and gives it this detail.
void set_wall(Stage& stage, SurfaceDetail detail);

[[nodiscard]] Result<SurfaceBench>
measure_surfaces(const BenchOptions& options, HeadlessRenderer& headless);

[[nodiscard]] SurfaceCost surface_cost(const SurfaceBench& bench, const SurfaceBenchPoint& point);

/// A text table with bars, one line per point.
[[nodiscard]] std::string surface_bench_table(const SurfaceBench& bench);
/// The schema is in `limn bench --help`.
[[nodiscard]] std::string surface_bench_json(const SurfaceBench& bench);
/// detail,frames,median_ms,gbuffer_ms,ratio
[[nodiscard]] std::string surface_bench_csv(const SurfaceBench& bench);

}  // namespace limn
