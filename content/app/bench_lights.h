#pragma once

#include "content/app/bench_report.h"
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

// What `limn bench lights` prints: what a frame costs against the number of lights that shine, by
// every LightMethod, in one run. A method ends where its next frame would take longer than
// kLongestLightFrame.

inline constexpr double kLongestLightFrame = 12.0;  ///< [s]

/// A method with so many lights.
struct LightsBenchPoint {
    int lights = 0;
    std::string left_out = {};  ///< why it was not measured; empty: it was
    BenchReport report = {};
};

struct LightsBench {
    BenchReport machine = {};      ///< of all: scene, size, threads, OpenGL; no series
    std::vector<int> counts = {};  ///< of lights, ascending
    /// By LightMethod and count.
    std::array<std::vector<LightsBenchPoint>, kLightMethods> points = {};
};

/// Powers of four from 16 to `lights`, and `lights`.
[[nodiscard]] std::vector<int> light_counts(int lights);

/// Lets `count` point lights shine, spread over them all, always the same ones. Returns how many
/// there are.
int shine_some(World& world, int count);

[[nodiscard]] Result<LightsBench>
measure_lights(Stage& stage, HeadlessRenderer& headless, const BenchOptions& options);

/// For people: a line a number of lights, a column a method; then what the passes of the clustered
/// method cost.
[[nodiscard]] std::string lights_bench_table(const LightsBench& bench);
/// The schema stands in `limn bench --help`.
[[nodiscard]] std::string lights_bench_json(const LightsBench& bench);
/// method,lights,frames,median_ms,p95_ms,max_ms
[[nodiscard]] std::string lights_bench_csv(const LightsBench& bench);

}  // namespace limn
