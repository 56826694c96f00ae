#pragma once

#include "ecs/base/math.h"
#include "render/gpu/buffer.h"
#include "render/gpu/program.h"
#include "render/graph/frame_graph.h"

namespace limn {

struct Exposure;

// Statistics of a picture, by compute, in two stages (hdr.log-average, hdr.dynamic-range,
// hdr.defog): mean color, log-average luminance, range; and the exposure that follows from them
// (hdr.key-scale), with an eye that adapts. All of it stays on the GPU.
//
// Reads    radiance
// Writes   a PictureMeasure (tone_gpu.h), which the tone map reads in the same frame
// Order    before the tone map
// Shaders  picture_statistics.comp, picture_measure.comp
//
// Pixels with NaN or infinity in them are counted and otherwise left out; others are clamped to
// 0 .. 65504. Sums are made in a fixed order: equal pictures have equal bits.

struct StatisticsPass {
    const gpu::Program* parts[2] = {};  ///< without and with a histogram
    const gpu::Program* join[2] = {};
    gpu::Buffer measure;    ///< PictureMeasure of the last picture, and what the eye is adapted to
    gpu::Buffer histogram;  ///< all 0 between pictures
};

[[nodiscard]] Result<StatisticsPass> create_statistics_pass(gpu::Device& device);

struct MeasureRequest {
    float key = 0.0f;                    ///< log-average after exposure; 0: scale 1, not metered
    float follow = 1.0f;                 ///< share of the way that the eye goes, 1 = at once
    Vec2 adaptable = {1e-4f, 65504.0f};  ///< luminances the eye follows between
    bool histogram = false;              ///< for the clipped range; costs more than all the rest
    float clipped_share = 0.001f;        ///< of the pixels, at either end
};

/// What an eye of time constant `adaptation` [s] follows in `seconds`: 1 - exp(-dt / tau).
[[nodiscard]] float eye_follows(float adaptation, float seconds);

/// Adds the passes to this frame.
[[nodiscard]] BufferId measure_picture(
    FrameGraph& graph, const StatisticsPass& pass, TextureId radiance,
    const MeasureRequest& request);

}  // namespace limn
