#pragma once

#include "ecs/components/surface.h"
#include "render/shaders/material_uv_gpu.h"

#include <cstdint>
#include <optional>

namespace limn {

// The textures of a material and where on the surface they lie.

inline constexpr int kMaterialTextures =
    5;  ///< base color, metal-rough, normal, occlusion, emission

[[nodiscard]] const TextureSlot& texture_slot(const Material& material, int i);

/// Same set of texture coordinates and same transform.
[[nodiscard]] bool same_uv(const TextureSlot& a, const TextureSlot& b);

/// The SurfaceFeature kUvMap, kUvMaps or, if all textures use the first set untransformed, 0.
[[nodiscard]] std::uint32_t uv_feature(const Material& material);

/// None if uv_feature() is 0. If all textures share one uv map, it is that of every slot.
[[nodiscard]] std::optional<layout::UvBlock> make_uv_block(const Material& material);

}  // namespace limn
