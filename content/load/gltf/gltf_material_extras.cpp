#include "content/load/gltf/gltf_material_extras.h"

#include "ecs/field_access.h"

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

tinygltf::Value value_of(const FieldInfo& field, const JsonValue& json) {
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

tinygltf::Value::Object
write_material_extras(const Material& material, const TextureWriter& texture) {
    const Material plain;
    tinygltf::Value::Object extras;
    for (const char* const name : kWrittenFields) {
        const FieldInfo& field = *find_field(material_fields(), name);
        const JsonValue json = written(field, material);
        if (json.text != written(field, plain).text) {
            extras.emplace(name, value_of(field, json));
        }
    }
    if (material.relief_texture.image.index != kNoAsset) {
        extras.emplace("relief_texture", tinygltf::Value(texture(material.relief_texture)));
    }
    return extras;
}

}  // namespace limn
