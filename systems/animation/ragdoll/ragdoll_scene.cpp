#include "systems/animation/ragdoll/ragdoll_scene.h"

#include "ecs/base/rotation.h"

#include <glm/gtc/quaternion.hpp>

#include <cstddef>

// Techniques: char.dynamics

namespace limn {

Quat matrix_rotation(const Affine& matrix) {
    Mat3 axes;
    for (int i = 0; i < 3; ++i) {
        axes[i] = {matrix.row[0][i], matrix.row[1][i], matrix.row[2][i]};
    }
    return extract_rotation(axes).value_or(Quat(1, 0, 0, 0));
}

RigidCapsule make_ragdoll_body(
    const RagdollBone& bone, const RagdollSize& size, const RigidVec& origin,
    const RigidQuat& rotation) {
    return make_capsule(
        RigidVec(bone.from * size.scale), RigidVec(bone.to * size.scale),
        static_cast<double>(bone.radius * size.scale * size.thickness),
        size.mass * static_cast<double>(bone.share), origin, rotation);
}

std::vector<RagdollJoint> make_ragdoll_joints(const RagdollRig& rig, const RagdollSize& size) {
    std::vector<RagdollJoint> joints;
    for (std::size_t i = 0; i < rig.bones.size(); ++i) {
        const RagdollBone& bone = rig.bones[i];
        if (bone.parent < 0) {
            continue;
        }
        const auto parent = static_cast<std::size_t>(bone.parent);
        const Vec3 center = 0.5f * (rig.bones[parent].from + rig.bones[parent].to);
        const RigidQuat rest = glm::normalize(RigidQuat(bone.rest));
        joints.push_back(
            {.parent = parent,
             .child = i,
             .anchor_parent = RigidVec((bone.anchor - center) * size.scale),
             .anchor_child = RigidVec(-0.5f * (bone.from + bone.to) * size.scale),
             .rest = rest,
             .limit = bone.limit,
             .target = rest});
    }
    return joints;
}

RagdollScene make_ragdoll_scene(
    const RagdollRig& rig, const RagdollSize& size, const Affine& world,
    std::span<const Affine> joints) {
    RagdollScene scene;
    std::vector<RigidVec> origins;
    for (const RagdollBone& bone : rig.bones) {
        const Affine joint = world * joints[bone.joint];
        RigidVec origin(transform_point(joint, Vec3(0)));
        if (bone.parent >= 0) {
            const auto parent = static_cast<std::size_t>(bone.parent);
            origin = origins[parent]
                     + scene.bodies[parent].rotation * RigidVec(bone.anchor * size.scale);
        }
        origins.push_back(origin);
        scene.bodies.push_back(make_ragdoll_body(
            bone, size, origin, glm::normalize(RigidQuat(matrix_rotation(joint)))));
    }
    scene.joints = make_ragdoll_joints(rig, size);
    return scene;
}

}  // namespace limn
