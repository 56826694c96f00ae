#include "systems/animation/walk/walk_body.h"

#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"
#include "systems/animation/ik/joint_tree.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

// Of a foot without toes, and of heels: relative to the length of the leg, by eye.
constexpr float kBallAhead = 0.16f;
constexpr float kHeelBehind = 0.06f;

Vec3 rest_position(const SkeletonData& skeleton, std::uint16_t joint) {
    return find_place(skeleton, skeleton.rest, joint).position;
}

Vec3 horizontal(const Vec3& v) {
    return {v.x, 0, v.z};
}

bool find_leg_joints(const BodyJoints& body, bool is_left, WalkLeg& leg) {
    const auto at = [&](BodyPart left, BodyPart right) { return body[is_left ? left : right]; };
    leg.thigh = at(BodyPart::LeftThigh, BodyPart::RightThigh);
    leg.shin = at(BodyPart::LeftShin, BodyPart::RightShin);
    leg.foot = at(BodyPart::LeftFoot, BodyPart::RightFoot);
    leg.toes = at(BodyPart::LeftToes, BodyPart::RightToes);
    return std::max({leg.thigh, leg.shin, leg.foot}) != BodyJoints::kNoJoint;
}

/// Height of the soles at rest: that of the character's origin, unless its joints are elsewhere.
float find_floor(const SkeletonData& skeleton, const WalkBody& body) {
    float lowest = INFINITY;
    for (const WalkLeg& leg : body.legs) {
        lowest = std::min(lowest, rest_position(skeleton, leg.foot).y);
        if (leg.toes != BodyJoints::kNoJoint) {
            lowest = std::min(lowest, rest_position(skeleton, leg.toes).y);
        }
    }
    const float length = leg_length(body);
    const bool is_near = lowest > -0.02f * length && lowest < 0.2f * length;
    return is_near ? 0.0f : lowest - 0.02f * length;
}

void measure_leg(const SkeletonData& skeleton, const WalkBody& body, float floor, WalkLeg& leg) {
    const Vec3 forward = {std::sin(body.heading), 0, std::cos(body.heading)};
    const Vec3 ankle = rest_position(skeleton, leg.foot);
    const Vec3 ground = {ankle.x, floor, ankle.z};
    leg.socket = rest_position(skeleton, leg.thigh) - body.hips_place;
    leg.side = glm::dot(leg.socket, glm::cross(Vec3(0, 1, 0), forward));
    leg.ankle = ankle - ground;
    leg.ball = kBallAhead * leg.length * forward;
    if (leg.toes != BodyJoints::kNoJoint) {
        leg.ball = rest_position(skeleton, leg.toes) - ground;
    }
    const Vec3 ahead = normalize_or(horizontal(leg.ball), forward);
    leg.across = glm::cross(Vec3(0, 1, 0), ahead);
    leg.heel = -kHeelBehind * leg.length * ahead;
}

void find_arm(const SkeletonData& skeleton, const BodyJoints& body, bool is_left, WalkArm& arm) {
    const auto at = [&](BodyPart left, BodyPart right) { return body[is_left ? left : right]; };
    arm.upper = at(BodyPart::LeftUpperArm, BodyPart::RightUpperArm);
    arm.fore = at(BodyPart::LeftForearm, BodyPart::RightForearm);
    arm.hand = at(BodyPart::LeftHand, BodyPart::RightHand);
    arm.collar = at(BodyPart::LeftShoulder, BodyPart::RightShoulder);
    if (std::max({arm.upper, arm.fore, arm.hand}) == BodyJoints::kNoJoint) {
        arm = {};
        return;
    }
    const Vec3 elbow = rest_position(skeleton, arm.fore);
    arm.upper_way = normalize_or(elbow - rest_position(skeleton, arm.upper), {0, -1, 0});
    arm.fore_way = normalize_or(rest_position(skeleton, arm.hand) - elbow, arm.upper_way);
}

}  // namespace

WalkBody find_walk_body(const SkeletonData& skeleton) {
    WalkBody body;
    const BodyJoints joints = find_body_joints(skeleton);
    const bool has_left = find_leg_joints(joints, true, body.legs[0]);
    const bool has_right = find_leg_joints(joints, false, body.legs[1]);
    if (!has_left || !has_right) {
        return body;
    }
    for (WalkLeg& leg : body.legs) {
        const Vec3 knee = rest_position(skeleton, leg.shin);
        leg.length = glm::distance(rest_position(skeleton, leg.thigh), knee)
                     + glm::distance(knee, rest_position(skeleton, leg.foot));
    }
    // What carries both legs.
    const std::int32_t above = skeleton.parents[body.legs[0].thigh];
    body.hips = joints.has(BodyPart::Hips) ? joints[BodyPart::Hips]
                                           : static_cast<std::uint16_t>(std::max(above, 0));
    body.hips_place = rest_position(skeleton, body.hips);
    const Vec3 left = horizontal(
        rest_position(skeleton, body.legs[0].thigh) - rest_position(skeleton, body.legs[1].thigh));
    const Vec3 forward = glm::cross(normalize_or(left, {1, 0, 0}), Vec3(0, 1, 0));
    body.heading = std::atan2(forward.x, forward.z);
    const float floor = find_floor(skeleton, body);
    body.can_walk = leg_length(body) > 1e-4f && is_finite(body.hips_place);
    for (std::size_t i = 0; i < 2; ++i) {
        measure_leg(skeleton, body, floor, body.legs[i]);
        find_arm(skeleton, joints, i == 0, body.arms[i]);
    }
    body.hips_place.y -= floor;
    body.spine = joints[BodyPart::Spine];
    body.chest = joints[BodyPart::Chest];
    body.head = joints[BodyPart::Head];
    return body;
}

}  // namespace limn
