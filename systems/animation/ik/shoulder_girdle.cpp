#include "systems/animation/ik/shoulder_girdle.h"

#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"
#include "systems/animation/ik/joint_tree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace limn {
namespace {

constexpr std::uint16_t kNone = 0xffff;
constexpr float kBegin = kPi / 6;    // elevation at which the girdle joins in [rad]
constexpr float kShare = 1.0f / 3;   // of the elevation beyond
constexpr float kSmooth = kPi / 18;  // to either side of the beginning [rad]

/// Angle from hanging [rad].
float elevation_of(const Vec3& way) {
    return std::atan2(std::hypot(way.x, way.z), -way.y);
}

}  // namespace

std::uint16_t find_collar(const SkeletonData& skeleton, std::uint16_t upper) {
    const BodyJoints body = find_body_joints(skeleton);
    for (const auto& [arm, collar] :
         {std::pair(BodyPart::LeftUpperArm, BodyPart::LeftShoulder),
          std::pair(BodyPart::RightUpperArm, BodyPart::RightShoulder)}) {
        if (body.has(arm) && body[arm] == upper) {
            return body[collar];
        }
    }
    return kNone;
}

float girdle_turn(float elevation, float rest_elevation) {
    const float beyond = elevation - std::max(kBegin, rest_elevation);
    if (std::abs(beyond) >= kSmooth) {
        return kShare * std::max(beyond, 0.0f);
    }
    return kShare * square(beyond + kSmooth) / (4 * kSmooth);
}

void raise_collar(
    const SkeletonData& skeleton, const ShoulderJoints& shoulder, float weight, LocalPose& pose) {
    const auto& [collar, upper, fore] = shoulder;
    if (std::max({collar, upper, fore}) >= pose.size() || !(weight > 0)) {
        return;
    }
    const auto rest = [&](std::int32_t joint) {
        return find_place(skeleton, skeleton.rest, joint);
    };
    const std::int32_t above = skeleton.parents[collar];
    const Quat turned =
        find_place(skeleton, pose, above).rotation * glm::conjugate(rest(above).rotation);
    const Vec3 bone = rest(upper).position - rest(collar).position;
    const Vec3 rest_way = rest(fore).position - rest(upper).position;
    const JointPlace arm = find_place(skeleton, pose, upper);
    const Vec3 way = find_place(skeleton, pose, fore).position - arm.position;
    const float turn =
        girdle_turn(elevation_of(glm::conjugate(turned) * way), elevation_of(rest_way));
    const Quat raised = rotation_about(glm::cross(bone, Vec3(0, 1, 0)), turn);
    set_joint_rotation(
        skeleton, collar, turned * raised * rest(collar).rotation, std::min(weight, 1.0f), pose);
    set_joint_rotation(skeleton, upper, arm.rotation, 1, pose);
}

Vec3 reach_with_arm(
    const SkeletonData& skeleton, std::uint16_t collar, const LimbJoints& limb,
    const LimbReach& reach, LocalPose& pose) {
    if (collar >= pose.size()) {
        return reach_with_limb(skeleton, limb, reach, pose);
    }
    const std::array<std::uint16_t, 3> joints = {collar, limb.root, limb.middle};
    std::array<Quat, 3> animated;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        animated[i] = pose.rotations[joints[i]];
    }
    LimbReach whole = reach;
    whole.weight = 1;
    reach_with_limb(skeleton, limb, whole, pose);
    raise_collar(skeleton, {collar, limb.root, limb.middle}, 1, pose);
    const Vec3 end = reach_with_limb(skeleton, limb, whole, pose);
    if (reach.weight < 1) {
        for (std::size_t i = 0; i < joints.size(); ++i) {
            Quat& now = pose.rotations[joints[i]];
            now = slerp(animated[i], now, std::max(reach.weight, 0.0f));
        }
    }
    return end;
}

}  // namespace limn
