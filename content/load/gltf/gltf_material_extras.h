#pragma once

#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_layers.h"
#include "content/load/level/component_json.h"
#include "ecs/base/result.h"
#include "ecs/components/surface.h"

#include <functional>
#include <string>

namespace limn {

// Materials may have fields that glTF has no members for, such as relief, in extras.limn. They are
// fields of Material by name; a texture is a textureInfo, as elsewhere in the file:
//
//     "extras": {"limn": {"detail": "silhouette", "relief_depth": 0.02,
//                         "relief_texture": {"index": 2}}}

/// Sets the fields that `limn` names; on an error some may be set. `texture`: the slot of the
/// textureInfo with this name.
[[nodiscard]] Status read_material_extras(
    const JsonValue& limn, const JsonLocation& location,
    const std::function<TextureSlot(const std::string& name)>& texture, Material& material);

/// Whether it is a shading model that glTF does not have, and that extras keep: other programs see
/// a material of glTF's own model.
[[nodiscard]] bool is_extra_model(ShadingModel model);

/// The fields of surface detail and of extra models that differ from those of a new material;
/// `texture` writes a textureInfo. Empty: none differs.
[[nodiscard]] tinygltf::Value::Object
write_material_extras(const Material& material, const TextureWriter& texture);

}  // namespace limn
