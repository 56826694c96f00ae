#include "content/load/gltf/gltf_material_extras.h"

#include "ecs/field_access.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {
namespace {

/// What is written: fields of how surfaces show detail.
constexpr const char* kWrittenFields[] = {
    "detail",        "relief_depth", "relief_steps", "relief_refinements",
    "relief_shadow", "tessellation", "normal_mips",  "bump_shadow"};

/// Likewise of shading models that glTF does not have, for which other programs use its own.
constexpr const char* kModelFields[] = {"shading",    "specular",        "scatter",
                                        "gloss",      "gloss_roughness", "roughness_across",
                                        "scale_tilt", "hair_scatter"};

const std::vector<FieldInfo>& material_fields() {
    return component_info<Material>().fields;
}

/// The slot that is the field `name`; null: it is none.
TextureSlot Material::*texture_field(std::string_view name) {
    static const std::pair<const char*, TextureSlot Material::*> kTextures[] = {
        {"relief_texture", &Material::relief_texture},
        {"detail_texture", &Material::detail_texture},
        {"wrinkle_texture", &Material::wrinkle_texture}};
    for (const auto& [known, slot] : kTextures) {
        if (name == known) {
            return slot;
        }
    }
    return nullptr;
}

JsonValue written(const FieldInfo& field, const Material& material) {
    return write_field(field, reinterpret_cast<const std::byte*>(&material) + field.offset, {});
}

bool is_same(const JsonValue& a, const JsonValue& b) {
    return a.text == b.text && std::ranges::equal(a.items, b.items, is_same);
}

tinygltf::Value value_of(const FieldInfo& field, const JsonValue& json) {
    if (json.kind == JsonKind::Array) {
        tinygltf::Value::Array items;
        for (const JsonValue& item : json.items) {
            items.emplace_back(item.number);
        }
        return tinygltf::Value(std::move(items));
    }
    if (json.kind != JsonKind::Number) {
        return tinygltf::Value(json.text);
    }
    return field.type == FieldType::Float ? tinygltf::Value(json.number)
                                          : tinygltf::Value(static_cast<int>(json.number));
}

}  // namespace

Status read_material_extras(
    const JsonValue& limn, const JsonLocation& location,
    const std::function<TextureSlot(const std::string& name)>& texture, Material& material) {
    LIMN_TRY(expect(limn, JsonKind::Object, location, "an object with fields of a material"));
    JsonValue plain = limn;
    plain.members.clear();
    for (const JsonMember& member : limn.members) {
        if (TextureSlot Material::*const slot = texture_field(member.key)) {
            material.*slot = texture(member.key);
        } else {
            plain.members.push_back(member);
        }
    }
    return read_struct(plain, material, location, {});
}

bool is_extra_model(ShadingModel model) {
    return model == ShadingModel::Subsurface || model == ShadingModel::Hair;
}

tinygltf::Value::Object
write_material_extras(const Material& material, const TextureWriter& texture) {
    const Material plain;
    tinygltf::Value::Object extras;
    const auto write = [&](const char* name) {
        const FieldInfo& field = *find_field(material_fields(), name);
        const JsonValue json = written(field, material);
        if (!is_same(json, written(field, plain))) {
            extras.emplace(name, value_of(field, json));
        }
    };
    std::ranges::for_each(kWrittenFields, write);
    if (is_extra_model(material.shading)) {
        std::ranges::for_each(kModelFields, write);
    }
    if (material.relief_texture.image.index != kNoAsset) {
        extras.emplace("relief_texture", tinygltf::Value(texture(material.relief_texture)));
    }
    return extras;
}

}  // namespace limn
