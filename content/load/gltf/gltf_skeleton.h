#pragma once

#include "content/load/gltf/gltf_scene.h"

#include <string>

namespace limn {

// Skeletons, clips and skins that were not loaded from glTF, as parts of a GltfScene, whose joint 0
// is the scene itself.

/// Makes `skeleton` that of the scene, below its joint 0, called `name`; and adds a node for each
/// of its joints. The scene must have no skeleton.
void add_skeleton(GltfScene& scene, const std::string& name, const SkeletonData& skeleton);

/// A clip and a skin of `skeleton` for the skeleton of the scene.
[[nodiscard]] ClipData below_scene(ClipData clip);
[[nodiscard]] SkinData below_scene(SkinData skin);

}  // namespace limn
