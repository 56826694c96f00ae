#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "content/load/files/load_warnings.h"
#include "content/load/gltf/gltf_scene.h"
#include "content/load/motion/bvh_motion.h"
#include "ecs/base/result.h"

#include <string>

namespace limn {

// Recorded motions as scenes to look at and to write as glTF: the skeleton, its clip and a figure
// of bones, in which the left side is blue and the right one orange.

/// A node per joint below a first one with the name, as load_gltf makes them. At rest the root of
/// the motion is where the clip begins.
[[nodiscard]] GltfScene make_motion_scene(const std::string& name, const SkeletonMotion& motion);

/// The scene of a .bvh file; its warnings are logged.
[[nodiscard]] Result<GltfScene> load_bvh_scene(
    const std::string& path, const BvhImport& options = {}, const LoadOptions& load = {});

}  // namespace limn
