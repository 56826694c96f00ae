#pragma once

#include "systems/animation/ragdoll/ragdoll_rig.h"
#include "systems/animation/ragdoll/ragdoll_solver.h"

#include <span>

namespace limn {

// The bodies of a rig, where a pose has them.

struct RagdollSize {
    double mass = 75;     ///< of all bodies [kg], > 0
    float scale = 1;      ///< of lengths
    float thickness = 1;  ///< of radii, > 0
};

[[nodiscard]] RigidCapsule make_ragdoll_body(
    const RagdollBone& bone, const RagdollSize& size, const RigidVec& origin,
    const RigidQuat& rotation);

/// One joint per bone but the first, at rest, with its limits.
[[nodiscard]] std::vector<RagdollJoint>
make_ragdoll_joints(const RagdollRig& rig, const RagdollSize& size);

/// At rest where the joints of a character are: the first bone is there, and all bones have their
/// rotations; anchors fit whatever the pose. `joints`: character_from_joint of all joints.
[[nodiscard]] RagdollScene make_ragdoll_scene(
    const RagdollRig& rig, const RagdollSize& size, const Affine& world,
    std::span<const Affine> joints);

/// Rotation of a matrix without its scale; the identity if it has none.
[[nodiscard]] Quat matrix_rotation(const Affine& matrix);

}  // namespace limn
