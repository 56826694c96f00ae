#pragma once

#include "render/effect.h"
#include "render/gpu/texture.h"

namespace limn {

// Composes normal maps of skin from its own and two wrinkle maps, by masks and weights
// (WrinkleMaps, wrinkle.maps.*).
//
// Reads    the images of every WrinkleMaps, WrinkleWeights
// Writes   its target, with mip levels
// Order    before surfaces are drawn
// Shaders  wrinkle_maps.frag, lib/wrinkle_maps.glsl
//
// One composite per character, whatever the number of pixels and passes that shade it.

struct WrinkleMapsEffect {
    const gpu::Program* program = nullptr;
    gpu::Sampler texels;

    static Result<WrinkleMapsEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    /// Skips a WrinkleMaps that lacks an image other than second and third masks, reads its own
    /// target, or has images of different aspect ratios. Weights are clamped to -1 .. 1, NaN is 0.
    void draw_shared(FrameGraph& graph, const FrameData& frame);
};

}  // namespace limn
