#pragma once

#include "content/app/bench/bench_report.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

struct BenchOptions;
struct HeadlessRenderer;
struct Stage;

// What `limn bench lens` prints: how much each lens effect adds to the frame time of one scene,
// alone, and how much ripple, motion blur, depth of field and glow add together. All measure the
// same frames.

inline constexpr const char* kLensScene = "stilllife";

/// Lens effects, as bit flags.
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

/// The scene with a set of effects enabled.
struct LensBenchPoint {
    std::string name = {};
    unsigned effects = kLensNothing;
    BenchReport report = {};
};

struct LensBench {
    BenchReport machine = {};  ///< shared by all points: scene, size, threads, OpenGL; no series
    std::vector<LensBenchPoint> points = {};  ///< the first has no effects
};

/// Cost of a point, medians [ms].
struct LensCost {
    double frame = 0;
    double added = 0;   ///< over a frame without effects
    double passes = 0;  ///< GPU time of the passes that such a frame does not have
};

/// No effects, each effect alone, and the four together.
[[nodiscard]] std::vector<LensBenchPoint> lens_points();

/// Enables `effects` with the level's settings, or the defaults where it has none, and disables all
/// others. The only ripple is one added here: hot air in front of the whole image.
void set_lens_effects(Stage& stage, unsigned effects);

[[nodiscard]] Result<LensBench>
measure_lens(const BenchOptions& options, HeadlessRenderer& headless);

[[nodiscard]] LensCost lens_cost(const LensBench& bench, const LensBenchPoint& point);

/// A text table, one line per point, then the pass times of the four effects together.
[[nodiscard]] std::string lens_bench_table(const LensBench& bench);
/// The schema is in `limn bench --help`.
[[nodiscard]] std::string lens_bench_json(const LensBench& bench);
/// effects,frames,median_ms,p95_ms,added_ms,passes_ms
[[nodiscard]] std::string lens_bench_csv(const LensBench& bench);

}  // namespace limn
