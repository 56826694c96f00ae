#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"

#include <string>

namespace limn {

class World;

/// Inputs of a deformed instance; valid until the world changes.
struct DeformSource {
    const SkinData* skin = nullptr;        ///< null: not skinned
    const Pose* pose = nullptr;            ///< with all joints of the skin unless wanted_joints > 0
    const MorphWeights* morphs = nullptr;  ///< null: no morph targets
    const DeformerState* deformers = nullptr;      ///< of the mesh itself; null: none
    const SurfaceBindingState* surface = nullptr;  ///< likewise, if it follows patches
    std::string fault;              ///< why it is drawn in rest pose; empty if it is deformed
    std::size_t wanted_joints = 0;  ///< how many the pose should have, if it has fewer; else 0
};

/// Finds the inputs of `entity`, an instance of `mesh`. `joint_count`: number of joints that the
/// mesh's weights refer to. The mesh itself must be valid (check_deformable).
[[nodiscard]] DeformSource find_deform_source(
    const World& world, const Assets& assets, Entity entity, MeshId mesh, std::size_t joint_count,
    const Deformed& settings);

}  // namespace limn
