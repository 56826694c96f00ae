#pragma once

#include "ecs/base/result.h"
#include "render/gpu/texture.h"

namespace limn {

namespace gpu {
class Device;
class Program;
}  // namespace gpu

// The mip levels of a 2D texture of floats that was drawn or computed. A software OpenGL uses
// glGenerateTextureMipmap; drivers of GPUs implement that by drawing, which is slow on data-center
// GPUs (subsurface_pass.h), so there a compute shader does it.
//
// Shaders  mip_level.comp

struct MipLevels {
    const gpu::Program* program = nullptr;  ///< null: glGenerateTextureMipmap
    gpu::Sampler sampler;
};

[[nodiscard]] Result<MipLevels> create_mip_levels(gpu::Device& device);

/// Fills the levels below the first, each by linear filtering at the centers of its texels. For a
/// pass that has declared to write the texture as an image().
void fill_mip_levels(gpu::Device& device, const MipLevels& levels, const gpu::Texture& texture);

}  // namespace limn
