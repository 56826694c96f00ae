#include "systems/animation/ragdoll/crouch.h"

#include "ecs/base/limb_reach.h"
#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"
#include "systems/animation/ik/joint_tree.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>

namespace limn {
namespace {

constexpr float kCrouchDrop = 0.42f;  // of the hips, in lengths of a leg
constexpr float kCrouchBack = 0.12f;  // likewise, so that the body is above its feet
constexpr float kCrouchLean = 0.8f;   // of the back [rad]

constexpr std::array<std::array<BodyPart, 3>, 2> kLegs = {
    {{BodyPart::LeftThigh, BodyPart::LeftShin, BodyPart::LeftFoot},
     {BodyPart::RightThigh, BodyPart::RightShin, BodyPart::RightFoot}}};

/// Turns a joint so that it has a rotation in the character's space.
void set_rotation_in_character(
    const SkeletonData& skeleton, std::uint16_t joint, const Quat& rotation, LocalPose& pose) {
    const JointPlace parent = find_place(skeleton, pose, skeleton.parents[joint]);
    pose.rotations[joint] = normalize_or_identity(glm::conjugate(parent.rotation) * rotation);
}

void move_in_character(
    const SkeletonData& skeleton, std::uint16_t joint, const Vec3& way, LocalPose& pose) {
    const JointPlace parent = find_place(skeleton, pose, skeleton.parents[joint]);
    if (parent.scale.x * parent.scale.y * parent.scale.z != 0) {
        pose.translations[joint] += glm::conjugate(parent.rotation) * way / parent.scale;
    }
}

}  // namespace

void crouch(const SkeletonData& skeleton, float amount, LocalPose& pose) {
    const BodyJoints body = find_body_joints(skeleton);
    bool is_person = body.has(BodyPart::Hips) && pose.size() == skeleton.parents.size();
    for (const auto& leg : kLegs) {
        for (const BodyPart part : leg) {
            is_person = is_person && body.has(part);
        }
    }
    if (!is_person || !(amount > 0)) {
        return;
    }
    const auto place = [&](BodyPart part) { return find_place(skeleton, pose, body[part]); };
    const std::array<JointPlace, 2> feet = {place(BodyPart::LeftFoot), place(BodyPart::RightFoot)};
    const Vec3 knee = place(BodyPart::LeftShin).position;
    const float leg = glm::distance(place(BodyPart::LeftThigh).position, knee)
                      + glm::distance(knee, feet[0].position);
    move_in_character(
        skeleton, body[BodyPart::Hips], amount * leg * Vec3(0, -kCrouchDrop, -kCrouchBack), pose);
    if (body.has(BodyPart::Spine)) {
        const Quat lean = rotation_about(Vec3(1, 0, 0), amount * kCrouchLean);
        set_rotation_in_character(
            skeleton, body[BodyPart::Spine], lean * place(BodyPart::Spine).rotation, pose);
    }
    for (std::size_t i = 0; i < kLegs.size(); ++i) {
        const JointPlace hip = place(kLegs[i][0]);
        const JointPlace middle = place(kLegs[i][1]);
        const TwoLinkTurns turns = reach_with_two_links(
            hip.position, middle.position, place(kLegs[i][2]).position, feet[i].position,
            Vec3(1, 0, 0));
        set_rotation_in_character(skeleton, body[kLegs[i][0]], turns.root * hip.rotation, pose);
        set_rotation_in_character(
            skeleton, body[kLegs[i][1]], turns.root * turns.middle * middle.rotation, pose);
        set_rotation_in_character(skeleton, body[kLegs[i][2]], feet[i].rotation, pose);
    }
}

}  // namespace limn
