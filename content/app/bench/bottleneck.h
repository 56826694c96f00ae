#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <string>

namespace limn {

struct HeadlessRenderer;
struct Stage;

// Which stage of the pipeline a frame waits for (engine.bottleneck; Wloka 2003): to speed up any
// other changes nothing. A pipeline of stages delivers a frame in the time of its slowest one, and
// each frame takes the sum of all.
//
// The stages are separated by experiments: an image with 1/64 of the pixels, then also a few
// triangles of each mesh. What that saves is the time of rasterization and of geometry; what is
// left is the application's. Software OpenGL runs all of them on the same cores, but the
// experiments hold.

enum class PipelineStage : std::uint8_t { Application, Geometry, Rasterization };

/// [ms] per frame.
struct PipelineTimes {
    double application = 0;    ///< simulation, culling, submission
    double geometry = 0;       ///< vertices
    double rasterization = 0;  ///< pixels
};

[[nodiscard]] PipelineStage find_bottleneck(const PipelineTimes& times);
/// Time between frames where the stages overlap [ms].
[[nodiscard]] double frame_period(const PipelineTimes& times);
/// From a frame's begin to its end [ms].
[[nodiscard]] double frame_latency(const PipelineTimes& times);

/// From the times of whole frames: as they are, with few pixels, with few triangles and pixels.
[[nodiscard]] PipelineTimes times_of_experiments(double whole, double few_pixels, double least);

/// Medians of `frames` frames for each experiment, after a third of that to warm up.
[[nodiscard]] PipelineTimes
measure_stages(Stage& stage, HeadlessRenderer& headless, const IVec2& size, int frames);

/// Three lines: a stage, its time and a bar each; then the bound.
[[nodiscard]] std::string bottleneck_text(const PipelineTimes& times);

}  // namespace limn
