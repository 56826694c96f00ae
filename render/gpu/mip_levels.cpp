#include "render/gpu/mip_levels.h"

#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/shaders/fullscreen_gpu.h"

namespace limn {
namespace {

constexpr int kMipGroup = 8;  ///< side of the work groups [px]

}  // namespace

Result<MipLevels> create_mip_levels(gpu::Device& device) {
    MipLevels levels;
    if (device.caps().profile == gpu::Profile::Gpu) {
        levels.program = LIMN_TRY(device.shaders().load({.compute = "mip_level.comp"}));
        levels.sampler = gpu::Sampler(
            "mip level", {.minify = GL_LINEAR_MIPMAP_NEAREST, .wrap = GL_CLAMP_TO_EDGE});
    }
    return levels;
}

void fill_mip_levels(gpu::Device& device, const MipLevels& levels, const gpu::Texture& texture) {
    if (levels.program == nullptr) {
        glGenerateTextureMipmap(texture.id());
        return;
    }
    device.use(*levels.program);
    device.bind_texture(layout::kSourceUnit, texture, &levels.sampler);
    for (int level = 1; level < texture.desc().levels; ++level) {
        if (level > 1) {
            glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
        }
        levels.program->set("source_level", level - 1);
        device.bind_image(layout::kTargetImage, texture, GL_WRITE_ONLY, level);
        device.dispatch_over(texture.width(level), texture.height(level), kMipGroup);
    }
}

}  // namespace limn
