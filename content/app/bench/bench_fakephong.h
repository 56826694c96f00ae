#pragma once

#include "bench/fakephong/fakephong_report.h"
#include "content/app/bench/bench_report.h"
#include "ecs/base/result.h"
#include "ecs/components/rendering.h"

#include <array>
#include <string>
#include <vector>

namespace limn {

struct BenchOptions;
struct HeadlessRenderer;

// What `limn bench fakephong` prints: what each ShadingRate costs beside per-pixel Phong shading,
// on each model of the level `phonglab`, under 1, 4 and 16 lights (fakephong.metric-efficiency).
//
// The time is that of the pass that draws and lights the surfaces. The methods alternate, frame by
// frame, so that other programs slow all of them; the best frame of each counts. Lights beyond
// those that a method stores terms of are lit per vertex, or dropped by the hardware of 2002.
//
// Beside it are the operations that the same methods take on a CPU, counted by the
// rasterizer of bench/fakephong in its own views of the models, under one light.

inline constexpr const char* kFakePhongScene = "phonglab";
inline constexpr std::array kFakePhongLights = {1, 4, 16};

/// One model under a number of lights.
struct FakePhongPoint {
    std::string model;
    int lights = 0;
    std::array<double, kShadingRates> best_ms = {};  ///< by ShadingRate
};

/// A method on a model, as bench/fakephong counts it.
struct FakePhongCount {
    std::string model;
    std::string method;
    fakephong::Efficiency efficiency;
};

struct FakePhongBench {
    BenchReport machine = {};  ///< scene, size, frames a method, threads, OpenGL; no series
    std::vector<FakePhongPoint> points = {};
    std::vector<FakePhongCount> counts = {};  ///< all methods of a model, then the next model
};

/// Models by methods; those that use forward differencing have a second line, ", stepped".
[[nodiscard]] std::vector<FakePhongCount> count_fakephong();

/// Draws options.frames frames of each method, model and number of lights.
[[nodiscard]] Result<FakePhongBench>
measure_fakephong(const BenchOptions& options, HeadlessRenderer& headless);

/// A text table: a line per method, a column per model and number of lights; ratios to `pixel`.
[[nodiscard]] std::string fakephong_bench_table(const FakePhongBench& bench);
/// The schema is in `limn bench --help`.
[[nodiscard]] std::string fakephong_bench_json(const FakePhongBench& bench);
/// model,lights,shading,frames,best_ms,ratio; then the counts, with a heading of their own.
[[nodiscard]] std::string fakephong_bench_csv(const FakePhongBench& bench);

}  // namespace limn
