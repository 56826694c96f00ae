#pragma once

#include "ecs/base/result.h"
#include "ecs/components/furrows.h"
#include "render/gpu/device.h"
#include "render/gpu/texture.h"

#include <cstdint>
#include <span>

namespace limn {

// Grows furrows on the GPU: like content/bake/furrow_height.h, with bit-identical heights. A furrow
// depends on all previous ones, so each field is one work group, whose invocations divide the
// pixels of a segment among them; noise and normals have one invocation per pixel.
//
// Shaders  furrow_trace.comp, furrow_maps.comp

struct FurrowMaker {
    const gpu::Program* trace = nullptr;
    const gpu::Program* maps = nullptr;
};

/// Fails with the shader compiler's message.
[[nodiscard]] Result<FurrowMaker> create_furrow_maker(gpu::Device& device);

/// Row 0 is the top row of the map, as in images of materials.
struct FurrowTextures {
    gpu::Texture height;  ///< RGBA32F: field 0, field 1, their minimum with noise, 1
    gpu::Texture normal;  ///< RGBA16F: unit; s to the right, t up, z outwards
};

/// `cover` holds the triangle of each pixel, or -1 (cover_furrow_map). Waits for the GPU every few
/// segments, so that no dispatch runs long.
[[nodiscard]] FurrowTextures make_furrow_textures(
    gpu::Device& device, const FurrowMaker& maker, const FurrowMap& map,
    std::span<const std::int32_t> cover, const FurrowStyle& style);

}  // namespace limn
