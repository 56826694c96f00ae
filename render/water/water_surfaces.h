#pragma once

#include "render/buffer_texture.h"
#include "render/water/ocean_textures.h"
#include "render/water/ripple_atlas.h"
#include "render/water/water_list.h"

namespace limn {

namespace gpu {
class Device;
}

// The surfaces of all waters of a frame, for every pass that asks where they are: what
// lib/water_surface.glsl reads.

struct WaterSurfaces {
    RippleAtlas ripples{};
    OceanTextures seas{};
    WaterList list{};
    BufferTexture bodies = BufferTexture("waters", GL_RGBA32F);
    BufferTexture lines = BufferTexture("wave lines", GL_RGBA32F);
    gpu::Texture wave_tiles{};  ///< slopes of waves that fit into a tile (texture_waves.frag)
    BufferTexture details = BufferTexture("water details", GL_RGBA32F);
    BufferTexture texture_waves = BufferTexture("texture waves", GL_RGBA32F);
    BufferTexture rings = BufferTexture("wave rings", GL_RGBA32F);
};

/// With the definition OCEAN where there are seas.
void bind_water_surfaces(gpu::Device& device, const WaterSurfaces& waters);

}  // namespace limn
