#pragma once

#include "render/effect.h"
#include "render/gpu/texture.h"

namespace limn {

// Blends stacks of moving images into images that materials use (TextureLayers, tex.layer-stack).
//
// Reads    the images of every TextureLayers
// Writes   its target, with mip levels
// Order    before surfaces are drawn
// Shaders  texture_layers.frag
//
// A pass per layer, between two textures of half floats, so that sums above 1 survive the layers
// between. By the time shown, independent of the frame rate. A layer without an image, or whose
// image is the target, is left out. After the multi-layer shaders of games; Cook, "Shade Trees",
// 1984.

struct TextureLayersEffect {
    const gpu::Program* program = nullptr;
    gpu::Sampler repeat;

    static Result<TextureLayersEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
};

}  // namespace limn
