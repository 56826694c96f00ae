#pragma once

#include "ecs/base/math.h"
#include "render/gpu/buffer.h"
#include "render/gpu/program.h"
#include "render/graph/frame_graph.h"
#include "render/variant.h"

namespace limn {

struct Exposure;

// Image statistics by compute in two stages (hdr.log-average, hdr.dynamic-range, hdr.defog): mean
// color, log-average luminance, range; and the auto exposure that follows from them
// (hdr.key-scale), with eye adaptation. All of it stays on the GPU.
//
// Reads    radiance; for MeasureRequest::depth the reversed depth of the G-buffer
// Writes   a ImageStatistics (tone_gpu.h), which the tone map reads in the same frame
// Order    before the tone map
// Shaders  image_statistics.comp, image_measure.comp
//
// Pixels with NaN or infinity are counted and otherwise skipped; others are clamped to 0 .. 65504.
// Sums have a fixed order: equal images give equal bits.

struct StatisticsPass {
    ProgramVariants parts;       ///< HISTOGRAM, SURFACES
    ProgramVariants join;        ///< HISTOGRAM
    gpu::Buffer measure = {};    ///< ImageStatistics of the last frame, and the adaptation state
    gpu::Buffer histogram = {};  ///< all 0 between frames
};

[[nodiscard]] Result<StatisticsPass> create_statistics_pass(gpu::Device& device);

struct MeasureRequest {
    float key = 0.0f;    ///< log-average after exposure; 0: scale 1, not metered
    float blend = 1.0f;  ///< adaptation blend factor, 1 = at once
    /// Luminance range of the adaptation. A lower end below kLogDelta also makes darker pixels
    /// count.
    Vec2 adaptation_range = {1e-4f, 65504.0f};
    bool histogram = false;        ///< for the clipped range; costs more than the rest together
    float clipped_share = 0.001f;  ///< of the pixels, at either end
    /// If valid, pixels with depth 0 (background) weigh 1 / kSurfaceWeight of others. As large as
    /// the image.
    TextureId depth = {};
};

/// Adaptation blend factor for time constant `adaptation` [s] over `seconds`: 1 - exp(-dt / tau).
[[nodiscard]] float adaptation_blend(float adaptation, float seconds);

/// Adds the passes to this frame.
[[nodiscard]] BufferId measure_image(
    FrameGraph& graph, StatisticsPass& pass, TextureId radiance, const MeasureRequest& request);

}  // namespace limn
