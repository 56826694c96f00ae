#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <string>
#include <vector>

namespace limn::bench {

// Measurements of `limn bench faces`: a crowd of faces that move and wrinkle, next to scalar
// versions in the same run.

/// The best time of a task next to that of a reference.
struct FaceRow {
    std::string name;
    double ours = 0;        ///< [ms], of the whole crowd
    double reference = 0;   ///< [ms]; 0: there is none
    std::string against{};  ///< name of the reference
    double limit = 0;       ///< of `ours` [ms], or of ours / reference; 0: none
    bool is_ratio = false;

    [[nodiscard]] double ratio() const { return reference > 0 ? ours / reference : 0; }
    [[nodiscard]] bool is_met() const { return limit == 0 || (is_ratio ? ratio() : ours) <= limit; }
};

/// Time per face of a task for a number of faces.
struct FaceGrowthPoint {
    std::string curve;
    std::size_t faces = 0;
    double ns = 0;
};

struct FaceBench {
    int repeats = 100;  ///< runs of each at most, of which the best counts
    bool quiet = false;
    std::vector<FaceRow> rows = {};
    std::vector<FaceGrowthPoint> growth = {};

    /// Both print a line immediately.
    void add(FaceRow row);
    void add(FaceGrowthPoint point);
};

/// name,ours_ms,reference_ms,against,ratio,limit,met and, after an empty line, curve,faces,ns
[[nodiscard]] std::string face_bench_csv(const FaceBench& bench);
/// {"threads", "rows": [{"name", "ours_ms", "reference_ms", "against", "ratio", "limit", "met"}],
/// "growth": [{"curve", "faces", "ns"}]}
[[nodiscard]] std::string face_bench_json(const FaceBench& bench);
/// Plots time per face over the number of faces.
[[nodiscard]] std::string face_bench_svg(const FaceBench& bench);

// The parts, in the order of the program.
void add_measure_rows(FaceBench& bench);  ///< compression, strain, intensities, weld
void add_deform_rows(FaceBench& bench);   ///< morph targets, muscles, joints, all of them
void add_face_growth(FaceBench& bench);   ///< 1 .. 100 faces
/// Wrinkled skin beside plain PBR. Fails without OpenGL.
[[nodiscard]] Status add_pixel_rows(FaceBench& bench);
/// Bodies with furrows by three models of reflection, beside Table 6.1 of Bando 2001. Fails without
/// OpenGL.
[[nodiscard]] Status add_furrow_rows(FaceBench& bench);

}  // namespace limn::bench
