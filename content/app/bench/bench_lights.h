#pragma once

#include "content/app/bench/bench_report.h"
#include "ecs/base/result.h"
#include "ecs/components/rendering.h"

#include <array>
#include <string>
#include <vector>

namespace limn {

class World;
struct BenchOptions;
struct HeadlessRenderer;
struct Stage;

// What `limn bench lights` prints: frame time over the number of enabled lights, for every
// LightMethod, in one run. A method stops where its next frame would take longer than
// kMaxLightFrame.

inline constexpr double kMaxLightFrame = 12.0;  ///< [s]

/// One method at one light count.
struct LightsBenchPoint {
    int lights = 0;
    std::string left_out = {};  ///< why it was not measured; empty if it was
    BenchReport report = {};
};

struct LightsBench {
    BenchReport machine = {};  ///< shared by all points: scene, size, threads, OpenGL; no series
    std::vector<int> counts = {};  ///< of lights, ascending
    /// By LightMethod and count.
    std::array<std::vector<LightsBenchPoint>, kLightMethods> points = {};
};

/// Powers of four from 16 to `lights`, and `lights`.
[[nodiscard]] std::vector<int> light_counts(int lights);

/// Enables `count` point lights, a fixed subset spread over the level, and disables the rest.
/// Returns the total number of point lights.
int enable_some_lights(World& world, int count);

[[nodiscard]] Result<LightsBench>
measure_lights(Stage& stage, HeadlessRenderer& headless, const BenchOptions& options);

/// A text table, one line per light count and one column per method, then the pass times of the
/// clustered method.
[[nodiscard]] std::string lights_bench_table(const LightsBench& bench);
/// The schema is in `limn bench --help`.
[[nodiscard]] std::string lights_bench_json(const LightsBench& bench);
/// method,lights,frames,median_ms,p95_ms,max_ms
[[nodiscard]] std::string lights_bench_csv(const LightsBench& bench);

}  // namespace limn
