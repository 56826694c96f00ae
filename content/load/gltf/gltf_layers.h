#pragma once

#include "ecs/components/surface.h"

#include <tiny_gltf.h>

#include <functional>

namespace limn {

// Extensions of materials whose members are fields of Material with the same meaning and default:
// KHR_materials_clearcoat, _sheen, _specular, _anisotropy, _iridescence and _dispersion.

/// Makes a textureInfo of a slot that has an image.
using TextureWriter = std::function<tinygltf::Value::Object(const TextureSlot& slot)>;

/// A texture of one of them.
struct LayerTexture {
    const char* extension;
    const char* member;
    TextureSlot Material::*slot;
    bool srgb = false;
};
inline constexpr LayerTexture kLayerTextures[] = {
    {"KHR_materials_clearcoat", "clearcoatTexture", &Material::clearcoat_texture},
    {"KHR_materials_clearcoat", "clearcoatRoughnessTexture",
     &Material::clearcoat_roughness_texture},
    {"KHR_materials_clearcoat", "clearcoatNormalTexture", &Material::clearcoat_normal_texture},
    {"KHR_materials_sheen", "sheenColorTexture", &Material::sheen_texture, true},
    {"KHR_materials_sheen", "sheenRoughnessTexture", &Material::sheen_roughness_texture},
    {"KHR_materials_specular", "specularTexture", &Material::specular_weight_texture},
    {"KHR_materials_specular", "specularColorTexture", &Material::specular_tint_texture, true},
    {"KHR_materials_anisotropy", "anisotropyTexture", &Material::anisotropy_texture},
    {"KHR_materials_iridescence", "iridescenceTexture", &Material::iridescence_texture},
    {"KHR_materials_iridescence", "iridescenceThicknessTexture",
     &Material::iridescence_thickness_texture},
};

/// Every map that a glTF file can have.
inline constexpr TextureSlot Material::*kGltfSlots[] = {
    &Material::base_color_texture,       &Material::metal_rough_texture,
    &Material::normal_texture,           &Material::occlusion_texture,
    &Material::emission_texture,         &Material::thickness_texture,
    &Material::clearcoat_texture,        &Material::clearcoat_roughness_texture,
    &Material::clearcoat_normal_texture, &Material::sheen_texture,
    &Material::sheen_roughness_texture,  &Material::specular_weight_texture,
    &Material::specular_tint_texture,    &Material::anisotropy_texture,
    &Material::iridescence_texture,      &Material::iridescence_thickness_texture,
    &Material::transmission_texture,
};

/// Maps that glTF does not have: those of extras.limn (gltf_material_extras.h), and light maps.
inline constexpr TextureSlot Material::*kExtraSlots[] = {
    &Material::relief_texture, &Material::detail_texture, &Material::wrinkle_texture,
    &Material::light_map_texture};

/// Sets the fields of the factors in these extensions.
void read_layer_factors(const tinygltf::ExtensionMap& extensions, Material& material);

/// The extensions with the factors of `material` that are not the default and with its maps, also
/// those of clear media; `texture` writes a textureInfo.
[[nodiscard]] tinygltf::ExtensionMap
write_layers(const Material& material, const TextureWriter& texture);

}  // namespace limn
