#pragma once

#include "content/load/gltf_scene.h"
#include "ecs/entity.h"

#include <vector>

namespace limn {

class World;

/// Puts a loaded scene into `world` and what it is drawn from into `assets`; cannot fail. Each node
/// becomes an entity with Transform, Parent unless it is a root, Name unless it has none,
/// MeshInstance, Camera, a light, and the components of its extras.limn, which win over those of
/// glTF. A node with several parts gets a child for each.
///
/// Returns the roots, in the file's order; they are children of `parent` unless that is null.
std::vector<Entity>
spawn_gltf(World& world, Assets& assets, GltfScene&& scene, Entity parent = Entity{});

}  // namespace limn
