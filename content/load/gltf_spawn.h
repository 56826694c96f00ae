#pragma once

#include "content/load/gltf_scene.h"
#include "ecs/components/animation.h"
#include "ecs/entity.h"

#include <vector>

namespace limn {

class World;

/// What makes an entity the character of a glTF file; indices are those of Assets.
struct GltfRig {
    SkeletonId skeleton;         ///< none: only morph targets move
    ClipPlayer player;           ///< the file's first clip, or none
    std::vector<float> weights;  ///< of all morph targets; may be empty
    bool is_character = false;   ///< whether the file has any of it
};

struct SpawnedGltf {
    std::vector<Entity> roots;  ///< in the file's order
    GltfRig rig;
};

/// Puts a loaded scene into `world` and what it is drawn from into `assets`; cannot fail. Each node
/// becomes an entity with Transform, Parent unless it is a root, Name unless it has none,
/// MeshInstance, Camera, a light, and the components of its extras.limn, which win over those of
/// glTF. A node with several parts gets a child for each. Roots are children of `parent` unless
/// that is null.
///
/// A file with joints or morph targets is one character: `parent`, or without one an entity of the
/// file's name that becomes the only root. It gets what make_character gives; a clip_player,
/// skeleton or morph_weights in extras.limn of any node is the character's. Nodes that are joints
/// become entities only where something is to hang on them - parts, a camera, a light, components,
/// children that are no joints, the name in a component - and then follow the joint
/// (JointAttachment). Skinned meshes are children of the character and Deformed.
SpawnedGltf spawn_gltf(World& world, Assets& assets, GltfScene&& scene, Entity parent = Entity{});

/// Gives `entity` the Skeleton, ClipPlayer and MorphWeights of the rig, where it has none of them
/// yet; a ClipPlayer without a clip gets the rig's, MorphWeights are filled up.
void make_character(World& world, Entity entity, const GltfRig& rig);

}  // namespace limn
