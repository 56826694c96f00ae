#pragma once

#include "content/load/gltf/gltf_file.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <set>
#include <string>
#include <utility>

namespace limn {

/// Appends the images as PNG. Fails on floats, which glTF does not have.
[[nodiscard]] Status append_images(tinygltf::Model& model, const GltfScene& scene);

/// The number of a texture with image, filter and wrapping of the slot, of which there is one; -1
/// without an image.
int append_texture(tinygltf::Model& model, const TextureSlot& slot);

/// Makes a textureInfo of tinygltf refer to the slot; `extensions`: those in use.
template <typename Info>
void write_texture_slot(
    tinygltf::Model& model, const TextureSlot& slot, Info& info,
    std::set<std::string>& extensions) {
    info.index = append_texture(model, slot);
    info.texCoord = slot.uv_set;
    if (info.index < 0 || (slot.offset == Vec2(0) && slot.scale == Vec2(1) && slot.rotation == 0)) {
        return;
    }
    const auto pair = [](const Vec2& v) {
        return tinygltf::Value(tinygltf::Value::Array{
            tinygltf::Value(static_cast<double>(v.x)), tinygltf::Value(static_cast<double>(v.y))});
    };
    tinygltf::Value::Object transform;
    transform.emplace("offset", pair(slot.offset));
    transform.emplace("scale", pair(slot.scale));
    transform.emplace("rotation", tinygltf::Value(static_cast<double>(slot.rotation)));
    info.extensions.emplace("KHR_texture_transform", tinygltf::Value(std::move(transform)));
    extensions.insert("KHR_texture_transform");
}

}  // namespace limn
