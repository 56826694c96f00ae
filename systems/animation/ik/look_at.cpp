#include "systems/animation/ik/look_at.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

LookAngles look_angles(const Vec3& direction) {
    const float level = std::hypot(direction.x, direction.z);
    return {
        level > 0 ? std::atan2(direction.x, direction.z) : 0.0f, std::atan2(direction.y, level)};
}

Vec3 look_direction(const LookAngles& angles) {
    const float level = std::cos(angles.pitch);
    return {level * std::sin(angles.yaw), std::sin(angles.pitch), level * std::cos(angles.yaw)};
}

float look_at(
    const SkeletonData& skeleton, std::span<const LookJoint> joints, const Vec3& target,
    float weight, LocalPose& pose) {
    float left = 0;
    if (!is_finite(target) || !(weight > 0)) {
        return left;
    }
    for (const LookJoint& look : joints) {
        // Seen from the joint that looks last, where the eyes are.
        const JointPlace eyes = find_place(skeleton, pose, joints.back().joint);
        const Vec3 wanted = target - eyes.position;
        if (!(glm::dot(wanted, wanted) > 1e-12f)) {
            continue;
        }
        const JointPlace place = find_place(skeleton, pose, look.joint);
        const Vec3 now = place.rotation * look.forward;
        const LookAngles from = look_angles(now);
        const LookAngles to = look_angles(wanted);
        const float share = std::clamp(look.share * weight, 0.0f, 1.0f);
        const float yaw = std::clamp(
            share * std::remainder(to.yaw - from.yaw, 2 * kPi), -look.max_yaw, look.max_yaw);
        const float pitch =
            std::clamp(share * (to.pitch - from.pitch), -look.max_pitch, look.max_pitch);
        // Up or down about the side, then about the up axis.
        const Vec3 side = {std::cos(from.yaw), 0, -std::sin(from.yaw)};
        const Quat turn = rotation_about(Vec3(0, 1, 0), yaw) * rotation_about(side, -pitch);
        const Quat& local = pose.rotations[look.joint];
        const Quat before = place.rotation * glm::conjugate(local);  // of the parent
        pose.rotations[look.joint] =
            normalize_or_identity(glm::conjugate(before) * turn * place.rotation);
        const Vec3 looks = turn * now;
        const Vec3 cross = glm::cross(looks, wanted);
        left = std::atan2(glm::length(cross), glm::dot(looks, wanted));
    }
    return left;
}

}  // namespace limn
