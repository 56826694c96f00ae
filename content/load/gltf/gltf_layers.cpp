#include "content/load/gltf/gltf_layers.h"

#include "content/load/gltf/gltf_document.h"

#include <map>
#include <string>
#include <utility>

namespace limn {

namespace {

/// A member of an extension and the field of Material for it.
template <typename T>
struct LayerFactor {
    const char* extension;
    const char* member;
    T Material::*field;
};

constexpr LayerFactor<float> kNumberFactors[] = {
    {"KHR_materials_clearcoat", "clearcoatFactor", &Material::clearcoat},
    {"KHR_materials_clearcoat", "clearcoatRoughnessFactor", &Material::clearcoat_roughness},
    {"KHR_materials_sheen", "sheenRoughnessFactor", &Material::sheen_roughness},
    {"KHR_materials_specular", "specularFactor", &Material::specular_weight},
    {"KHR_materials_anisotropy", "anisotropyStrength", &Material::anisotropy},
    {"KHR_materials_anisotropy", "anisotropyRotation", &Material::anisotropy_rotation},
    {"KHR_materials_iridescence", "iridescenceFactor", &Material::iridescence},
    {"KHR_materials_iridescence", "iridescenceIor", &Material::iridescence_index},
    {"KHR_materials_dispersion", "dispersion", &Material::dispersion},
};
constexpr LayerFactor<Vec3> kColorFactors[] = {
    {"KHR_materials_sheen", "sheenColorFactor", &Material::sheen},
    {"KHR_materials_specular", "specularColorFactor", &Material::specular_tint},
};
constexpr const char* kIridescence = "KHR_materials_iridescence";
constexpr const char* kThinnest = "iridescenceThicknessMinimum";
constexpr const char* kThickest = "iridescenceThicknessMaximum";

/// Of fields that other extensions have a rule of their own for when they are read.
constexpr LayerFactor<float> kClearNumbers[] = {
    {"KHR_materials_transmission", "transmissionFactor", &Material::transmission},
    {"KHR_materials_ior", "ior", &Material::refractive_index},
    {"KHR_materials_volume", "thicknessFactor", &Material::thickness},
};

tinygltf::Value to_value(float number) {
    return tinygltf::Value(static_cast<double>(number));
}
tinygltf::Value to_value(const Vec3& color) {
    return tinygltf::Value(
        tinygltf::Value::Array{to_value(color.x), to_value(color.y), to_value(color.z)});
}

}  // namespace

void read_layer_factors(const tinygltf::ExtensionMap& extensions, Material& material) {
    for (const auto& [extension, member, field] : kNumberFactors) {
        float& number = material.*field;
        number = number_of(extension_of(extensions, extension), member, number);
    }
    for (const auto& [extension, member, field] : kColorFactors) {
        Vec3& color = material.*field;
        color = vector_of(extension_of(extensions, extension), member, color);
    }
    const tinygltf::Value& film = extension_of(extensions, kIridescence);
    Vec2& thickness = material.iridescence_thickness;
    thickness = {number_of(film, kThinnest, thickness.x), number_of(film, kThickest, thickness.y)};
}

tinygltf::ExtensionMap write_layers(const Material& material, const TextureWriter& texture) {
    const Material standard;
    std::map<std::string, tinygltf::Value::Object> objects;
    const auto write = [&](const char* extension, const char* member, const auto& value,
                           const auto& missing) {
        if (value != missing) {
            objects[extension].emplace(member, to_value(value));
        }
    };
    for (const auto& [extension, member, field] : kNumberFactors) {
        write(extension, member, material.*field, standard.*field);
    }
    for (const auto& [extension, member, field] : kColorFactors) {
        write(extension, member, material.*field, standard.*field);
    }
    for (const auto& [extension, member, field] : kClearNumbers) {
        write(extension, member, material.*field, standard.*field);
    }
    const Vec2& thickness = material.iridescence_thickness;
    write(kIridescence, kThinnest, thickness.x, standard.iridescence_thickness.x);
    write(kIridescence, kThickest, thickness.y, standard.iridescence_thickness.y);
    if (material.attenuation_color != Vec3(1)) {
        write("KHR_materials_volume", "attenuationColor", material.attenuation_color, Vec3(1));
        write("KHR_materials_volume", "attenuationDistance", material.attenuation_distance, 0.0f);
    }
    const auto write_map = [&](const char* extension, const char* member, const TextureSlot& slot) {
        if (slot.image.index == kNoAsset) {
            return;
        }
        tinygltf::Value::Object info = texture(slot);
        if (&slot == &material.clearcoat_normal_texture && material.clearcoat_normal_scale != 1) {
            info.emplace("scale", to_value(material.clearcoat_normal_scale));
        }
        objects[extension].emplace(member, tinygltf::Value(std::move(info)));
    };
    for (const LayerTexture& map : kLayerTextures) {
        write_map(map.extension, map.member, material.*map.slot);
    }
    write_map("KHR_materials_volume", "thicknessTexture", material.thickness_texture);
    write_map("KHR_materials_transmission", "transmissionTexture", material.transmission_texture);
    tinygltf::ExtensionMap extensions;
    for (auto& [name, object] : objects) {
        extensions.emplace(name, tinygltf::Value(std::move(object)));
    }
    return extensions;
}

}  // namespace limn
