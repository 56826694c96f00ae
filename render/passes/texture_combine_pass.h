#pragma once

#include "render/frame_scene.h"

namespace limn {

class World;

// Combines images into one that materials show (TextureCombine, tex.combine).
//
// Reads    the images of every TextureCombine
// Writes   its target, and smaller levels of it
// Order    before surfaces are drawn
// Shaders  texture_combine.frag
//
// By the time that is shown, whatever the pictures a second. Who combines a target of another
// should stand after it.

struct TextureCombinePass {
    const gpu::Program* program = nullptr;
    gpu::Sampler repeat{};
};

[[nodiscard]] Result<TextureCombinePass> create_texture_combine_pass(gpu::Device& device);

/// `time` that is shown [s]. Nothing without a TextureCombine; one that lacks an image, or reads
/// its target, is left out. Returns how many there are.
int combine_textures(
    FrameGraph& graph, const TextureCombinePass& pass, const World& world,
    const MaterialPool& materials, double time);

}  // namespace limn
