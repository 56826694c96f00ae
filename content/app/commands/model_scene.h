#pragma once

#include "content/app/commands/command_values.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// A generated model.
struct ModelOptions {
    std::string kind;                          ///< of mesh_kinds()
    std::string name;                          ///< of the scene
    bool parts = false;                        ///< each value of its field `part` as a mesh
    std::vector<Assignment> assignments = {};  ///< FIELD=VALUE of the kind
};

/// Its mesh with its skin, skeleton and clips, without weights of morph targets in clips. Fails
/// with one line on an unknown kind or field, and where the model is empty.
[[nodiscard]] Result<GltfScene> make_model_scene(const ModelOptions& options);

}  // namespace limn
