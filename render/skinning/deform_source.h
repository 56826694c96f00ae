#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"

#include <string>

namespace limn {

class World;

/// What a deformed instance follows; good until the world changes.
struct DeformSource {
    const SkinData* skin = nullptr;        ///< null: no joints move it
    const Pose* pose = nullptr;            ///< has all joints of the skin
    const MorphWeights* morphs = nullptr;  ///< null: no morph target is on
    std::string fault;                     ///< why it is drawn at rest; empty if it is not
};

/// `joint_count`: how many joints the mesh's weights name. The mesh itself must be whole
/// (check_deformable).
[[nodiscard]] DeformSource find_deform_source(
    const World& world, const Assets& assets, MeshId mesh, std::uint32_t joint_count,
    const Deformed& settings);

}  // namespace limn
