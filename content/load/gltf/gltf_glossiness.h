#pragma once

#include "content/load/gltf/gltf_document.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <span>

namespace limn {

// KHR_materials_pbrSpecularGlossiness as metallic-roughness: a specular color that neither a metal
// nor a dielectric can have becomes the nearest possible one. The conversion is that of Khronos (G.
// Hsu, "Converting between workflows", in the archived repository of the extension).

struct MetallicRoughness {
    Vec3 base_color = {0, 0, 0};
    float metalness = 0;
    float roughness = 0;
};

/// Converts linear colors; all values are 0 .. 1.
[[nodiscard]] MetallicRoughness
metallic_from_specular(const Vec3& diffuse, const Vec3& specular, float glossiness);

/// A material whose base_color is the diffuse factor, whose base_color_texture is the diffuse
/// texture and whose metal_rough_texture is the texture of specular color and glossiness.
struct GlossyMaterial {
    std::uint32_t material = 0;
    Vec3 specular = {1, 1, 1};
    float glossiness = 1;
};

/// Converts factors and, per texel, textures: `scene` gets images for each pair of them, and loses
/// those that no material uses any more. If the two have different texture coordinates, both get
/// those of the first, with a warning. Fails when the images have too many pixels.
[[nodiscard]] Status convert_glossy_materials(
    GltfDocument& document, GltfScene& scene, std::span<const GlossyMaterial> glossy);

}  // namespace limn
