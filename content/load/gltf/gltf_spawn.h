#pragma once

#include "content/load/gltf/gltf_scene.h"
#include "ecs/components/animation.h"
#include "ecs/entity.h"

#include <vector>

namespace limn {

class World;

/// Components that make an entity the character of a glTF file; indices are into Assets.
struct GltfRig {
    SkeletonId skeleton;         ///< none: only morph targets are animated
    ClipPlayer player;           ///< the file's first clip, or none
    std::vector<float> weights;  ///< of all morph targets; may be empty
    bool is_character = false;   ///< whether the file has joints or morph targets
};

struct SpawnedGltf {
    std::vector<Entity> roots;  ///< in the file's order
    GltfRig rig;
};

/// Spawns a loaded scene into `world` and its assets into `assets`; cannot fail. Each node becomes
/// an entity with FromGltf, Transform, Parent unless it is a root, Name unless it has none,
/// MeshInstance, Camera, a light, and the components of its extras.limn, which override those of
/// glTF. A node with several parts gets a child for each. Roots are children of `parent` unless
/// that is null.
///
/// A file with joints or morph targets is one character: `parent`, or without one a new entity with
/// the file's name as the only root. It gets the components of make_character; a clip_player,
/// skeleton or morph_weights in extras.limn of any node goes to the character. Joint nodes become
/// entities, with a JointAttachment, only if something needs them: parts, a camera, a light,
/// components, children that are no joints, a name in a level's "nodes", or a reference from a
/// component. Skinned meshes are
/// children of the character and Deformed.
SpawnedGltf spawn_gltf(World& world, Assets& assets, GltfScene&& scene, Entity parent = Entity{});

/// Adds the Skeleton, ClipPlayer and MorphWeights of the rig to `entity` where missing; a
/// ClipPlayer without a clip gets the rig's, MorphWeights that are too short are extended.
void make_character(World& world, Entity entity, const GltfRig& rig);

}  // namespace limn
