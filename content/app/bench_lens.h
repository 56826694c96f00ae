#pragma once

#include "content/app/bench_report.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

struct BenchOptions;
struct HeadlessRenderer;
struct Stage;

// What `limn bench lens` prints: what each effect of the lens adds to a frame of one scene, alone,
// and what ripple, motion blur, depth of field and glow add together. Every one sees the same
// frames.

inline constexpr const char* kLensScene = "stilllife";

/// What can be between the scene and the film, bits.
enum LensEffect : unsigned {
    kLensNothing = 0,
    kLensAntialiasing = 1,
    kLensRipple = 2,
    kLensMotionBlur = 4,
    kLensDepthOfField = 8,
    kLensGlow = 16,
    kLensGlare = 32,
    kLensFour = kLensRipple | kLensMotionBlur | kLensDepthOfField | kLensGlow,
};

/// A scene with some of them.
struct LensBenchPoint {
    std::string name = {};
    unsigned effects = kLensNothing;
    BenchReport report = {};
};

struct LensBench {
    BenchReport machine = {};                 ///< of all: scene, size, threads, OpenGL; no series
    std::vector<LensBenchPoint> points = {};  ///< the first with none of the effects
};

/// What a point costs [ms], medians.
struct LensCost {
    double frame = 0;
    double added = 0;   ///< to a frame with none of the effects
    double passes = 0;  ///< of those that are not in such a frame, on the GPU's clock
};

/// Nothing, each alone, and the four.
[[nodiscard]] std::vector<LensBenchPoint> lens_points();

/// Turns on `effects` as the level has them, or as they are by default where it has none, and all
/// others off. Of ripples only those that are turned on here: hot air before the whole picture.
void set_lens_effects(Stage& stage, unsigned effects);

[[nodiscard]] Result<LensBench>
measure_lens(const BenchOptions& options, HeadlessRenderer& headless);

[[nodiscard]] LensCost lens_cost(const LensBench& bench, const LensBenchPoint& point);

/// For people: a line a point; then what the passes of the four cost.
[[nodiscard]] std::string lens_bench_table(const LensBench& bench);
/// The schema stands in `limn bench --help`.
[[nodiscard]] std::string lens_bench_json(const LensBench& bench);
/// effects,frames,median_ms,p95_ms,added_ms,passes_ms
[[nodiscard]] std::string lens_bench_csv(const LensBench& bench);

}  // namespace limn
