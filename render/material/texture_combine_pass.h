#pragma once

#include "render/effect.h"
#include "render/gpu/texture.h"

namespace limn {

// Combines images into one that materials use (TextureCombine, tex.combine).
//
// Reads    the images of every TextureCombine
// Writes   its target, with mip levels
// Order    before surfaces are drawn
// Shaders  texture_combine.frag
//
// Animated by the time shown, independent of the frame rate. A TextureCombine that reads the target
// of another should come after it.

struct TextureCombineEffect {
    const gpu::Program* program = nullptr;
    gpu::Sampler repeat;

    static Result<TextureCombineEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    /// Skips a TextureCombine that lacks an image or reads its own target.
    void collect(FrameData& frame);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
};

}  // namespace limn
