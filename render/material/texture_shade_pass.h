#pragma once

#include "render/effect.h"
#include "render/gpu/texture.h"

namespace limn {

// Lights images in their own space (TextureShade, wrinkle.furrow.texture-space-shading).
//
// Reads    the images of every TextureShade
// Writes   its target, with mip levels
// Order    before surfaces are drawn
// Shaders  texture_shade.frag
//
// Normals are rotated into camera space: those of an unrolled cylinder are rolled up first. One
// image per frame, whatever the number of views: mirrors and probes show the lighting for the
// camera.

struct TextureShadeEffect {
    const gpu::Program* program = nullptr;
    gpu::Sampler texels;

    static Result<TextureShadeEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    /// Skips a TextureShade that lacks an image or reads its own target.
    void collect(FrameData& frame);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
};

}  // namespace limn
