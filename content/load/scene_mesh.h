#pragma once

#include "ecs/base/result.h"
#include "ecs/components/surface.h"

#include <string>

namespace limn {

struct GltfScene;

/// The meshes of a scene, without skeleton and shapes, as one in the space of the scene; `name`:
/// only those, or the nodes with them; empty: all. Tangents and texture coordinates where all have
/// them. Fails where there is none of that name or no triangle; `path` starts the message.
[[nodiscard]] Result<MeshData>
join_meshes(const GltfScene& scene, const std::string& name, const std::string& path);

/// A file, .gltf, .glb or .obj, as a scene; components must be registered.
[[nodiscard]] Result<GltfScene> load_model_scene(const std::string& path);

/// join_meshes of a file.
[[nodiscard]] Result<MeshData> load_joined_mesh(const std::string& path, const std::string& name);

}  // namespace limn
