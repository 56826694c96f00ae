#pragma once

#include "content/make/models/creature.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <string>

namespace limn {

// Articulated models of rigid parts: machines, puppets. Each part is bound to a single joint.

/// Where a part is in the space of its joint, and its color.
struct RigidPart {
    std::uint16_t joint = 0;
    Vec3 position = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
    Vec3 scale = {1, 1, 1};
    Vec3 color = {1, 1, 1};  ///< factor on the color of the material, linear
};

/// Appends a mesh of the joint's rest space as a part. `skeleton`: with rest positions, without
/// rest rotations.
void append_rigid(
    MeshData& mesh, const SkeletonData& skeleton, const MeshData& part, const RigidPart& at);

/// Ends a mesh of parts: bounds, last entry of its weights.
void finish_rigid(MeshData& mesh);

/// Adds a joint without rest rotation; `parent` -1: the root.
std::uint16_t
add_rigid_joint(SkeletonData& skeleton, std::string name, std::int32_t parent, const Vec3& offset);

/// Position of a joint in the rest pose.
[[nodiscard]] Vec3 rest_position(const SkeletonData& skeleton, std::int32_t joint);

/// The skin of all joints of a skeleton without rest rotations.
[[nodiscard]] SkinData make_rigid_skin(const SkeletonData& skeleton);

}  // namespace limn
