#pragma once

#include "render/frame_data.h"
#include "render/gpu/pipeline_state.h"

namespace limn {

namespace gpu {
class Program;
}

// Order-independent transparency (McGuire and Bavoil, "Weighted Blended Order-Independent
// Transparency", 2013): the colors of all layers at a pixel are averaged by opacity times a weight
// that falls with the distance, and cover the background by the exact product of transmittances. A
// single layer is exact, and so is the background behind all layers; among layers the nearer one
// wins by weight alone, so layers behind a nearly opaque one still show through.
//
// The weight is exp(-kWeightFall t), t = 0 .. 1 from the nearest to the farthest particle: the
// transmittance in front of a layer in a homogeneous cloud of that optical depth. So it depends
// neither on the unit of length nor on the camera's near and far planes, and distant layers stay
// distinguishable.

struct WeightedLayers {
    TextureId sum;   ///< RGBA32F: premultiplied radiance, and opacity in a, times the weights
    TextureId kept;  ///< R16: product of the transmittances; 8 bits would show bands
};

[[nodiscard]] WeightedLayers create_weighted_layers(FrameGraph& graph, const ViewData& view);

/// Draws into both at once; the first target is `sum`.
inline constexpr gpu::PipelineState kWeightedState = {
    .depth = {.write = false},
    .blend = gpu::kBlendAdd,
    .second_blend = gpu::kBlendTransmit,
    .cull = GL_NONE};

/// Distance along the view axis of the nearest point of a box [m], at least the near plane's, and
/// 1 / (farthest - nearest) [1/m]: the uniform `weight_range`. The box may be infinite or empty.
[[nodiscard]] Vec2 weight_range(const Bounds& bounds, const RenderView& view);

/// Adds the pass that composites their mean over the view's radiance; `program`:
/// particle_weighted.frag.
void resolve_weighted(
    FrameGraph& graph, const gpu::Program& program, const WeightedLayers& layers, ViewData& view);

}  // namespace limn
