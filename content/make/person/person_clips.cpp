#include "content/make/person/person_clips.h"

#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace limn {

namespace {

/// Rotations of some joints from the rest pose, and where the hips are.
struct KeyPose {
    std::map<std::uint16_t, Quat> turns;
    Vec3 hips = {};  ///< offset from the rest pose, reference units [m]

    void turn(PersonJoint joint, const Vec3& axis, float angle) {
        turn(joint_index(joint), axis, angle);
    }
    /// Both sides, mirrored.
    void turn(SideJoint joint, const Vec3& axis, float angle) {
        turn(joint_index(joint, 1), axis, angle);
        turn(joint_index(joint, -1), {axis.x, -axis.y, -axis.z}, angle);
    }

    /// How far the ankles are above the floor that the person stands on at rest, if the hips stay.
    [[nodiscard]] float raised_feet(const PersonFrame& frame) const {
        Quat turned(1, 0, 0, 0);
        float height = frame.at(PersonJoint::Hips).y;
        Vec3 from = frame.at(PersonJoint::Hips);
        for (const SideJoint joint : {SideJoint::Thigh, SideJoint::Shin, SideJoint::Foot}) {
            height += (turned * (frame.at(joint) - from)).y;
            from = frame.at(joint);
            const auto found = turns.find(joint_index(joint, 1));
            turned = found == turns.end() ? turned : turned * found->second;
        }
        return height - from.y;
    }

  private:
    void turn(std::uint16_t joint, const Vec3& axis, float angle) {
        const auto [found, added] = turns.try_emplace(joint, Quat(1, 0, 0, 0));
        found->second = found->second * rotation_about(axis, radians(angle));
    }
};

void curl_fingers(KeyPose& pose, const PersonFrame& frame, float degrees) {
    for (int bone = 0; bone < 12; ++bone) {
        const auto joint = static_cast<SideJoint>(static_cast<int>(SideJoint::Index1) + bone);
        const float share = bone % 3 == 2 ? 0.7f : 1.0f;
        pose.turn(joint, -frame.hand.thumb, share * degrees);
    }
}

/// From the rest pose to arms that hang.
void lower_arms(KeyPose& pose, const PersonFrame& frame, float more = 0) {
    pose.turn(SideJoint::Shoulder, {0, 0, 1}, -4);
    const float girth = 4 * std::max(frame.build, 0.0f);
    const float coat = frame.look.shape.top == PersonTop::Coat ? 3.0f : 0.0f;
    pose.turn(SideJoint::UpperArm, {0, 0, 1}, -36 + girth + coat + more);
    pose.turn(SideJoint::UpperArm, {1, 0, 0}, 5);
    pose.turn(SideJoint::Forearm, -frame.forearm.back, 13);
}

KeyPose standing(const PersonFrame& frame, float phase) {
    const float breath = std::sin(phase);
    const float sway = std::sin(0.5f * phase);
    KeyPose pose;
    lower_arms(pose, frame, 0.7f * breath);
    curl_fingers(pose, frame, 13 + 1.5f * sway);
    pose.turn(SideJoint::Thumb1, frame.hand.back, 16);
    pose.turn(SideJoint::Hand, frame.forearm.along, -14);
    pose.turn(SideJoint::Thigh, {0, 1, 0}, 7);
    pose.turn(PersonJoint::Chest, {1, 0, 0}, -0.7f * breath);
    pose.turn(PersonJoint::UpperChest, {1, 0, 0}, -0.7f * breath);
    pose.turn(PersonJoint::Head, {1, 0, 0}, 1.2f * std::sin(phase - 0.6f));
    pose.turn(PersonJoint::Head, {0, 1, 0}, 4 * sway);
    pose.turn(PersonJoint::Spine, {0, 0, 1}, 0.7f * sway);
    return pose;
}

KeyPose arms_up(const PersonFrame&) {
    KeyPose pose;
    // Of what the arms are raised beyond 45 degrees, collar bones take a third.
    pose.turn(SideJoint::Shoulder, {0, 0, 1}, 36);
    pose.turn(SideJoint::UpperArm, {0, 0, 1}, 72);
    return pose;
}

KeyPose sitting(const PersonFrame& frame) {
    KeyPose pose;
    lower_arms(pose, frame, 6);
    pose.turn(SideJoint::UpperArm, {1, 0, 0}, -22);
    pose.turn(SideJoint::Forearm, -frame.forearm.back, 42);
    pose.turn(SideJoint::Thigh, {1, 0, 0}, -86);
    pose.turn(SideJoint::Shin, {1, 0, 0}, 86);
    pose.hips = {0, -pose.raised_feet(frame), -0.1f};
    return pose;
}

KeyPose squatting(const PersonFrame& frame) {
    KeyPose pose = sitting(frame);
    pose.turn(SideJoint::Thigh, {1, 0, 0}, -24);
    pose.turn(SideJoint::Shin, {1, 0, 0}, 44);
    pose.turn(SideJoint::Foot, {1, 0, 0}, -20);
    pose.turn(SideJoint::UpperArm, {1, 0, 0}, -40);
    pose.turn(PersonJoint::Spine, {1, 0, 0}, 14);
    pose.turn(PersonJoint::Chest, {1, 0, 0}, 12);
    pose.hips.y = -pose.raised_feet(frame);
    return pose;
}

KeyPose fists(const PersonFrame& frame) {
    KeyPose pose;
    lower_arms(pose, frame);
    pose.turn(SideJoint::Forearm, -frame.forearm.back, 95);
    curl_fingers(pose, frame, 72);
    pose.turn(SideJoint::Thumb1, frame.hand.thumb, -12);
    pose.turn(SideJoint::Thumb2, glm::cross(frame.hand.along, -frame.hand.thumb), 20);
    pose.turn(SideJoint::Thumb3, glm::cross(frame.hand.along, -frame.hand.thumb), 40);
    return pose;
}

/// Hands before the body, turned about the forearms by a quarter.
KeyPose palms_up(const PersonFrame& frame) {
    KeyPose pose;
    lower_arms(pose, frame, 8);
    pose.turn(SideJoint::Forearm, -frame.forearm.back, 72);
    pose.turn(SideJoint::Hand, frame.forearm.along, -90);
    curl_fingers(pose, frame, 10);
    return pose;
}

/// A clip of poses that turn the same joints, at equal steps.
ClipData make_clip(
    const char* name, float duration, const std::vector<KeyPose>& poses, const PersonFrame& frame) {
    ClipData clip;
    clip.name = name;
    clip.duration = duration;
    ClipSheet sheet;
    for (const auto& [joint, turn] : poses.front().turns) {
        sheet.rotating.push_back(joint);
    }
    sheet.translating = {joint_index(PersonJoint::Hips)};
    const Vec3 hips = frame.at(PersonJoint::Hips);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        sheet.times.push_back(
            duration * static_cast<float>(i) / static_cast<float>(poses.size() - 1));
        for (const auto& [joint, turn] : poses[i].turns) {
            sheet.rotations.push_back(turn);
        }
        sheet.translations.push_back(frame.scale * (hips + poses[i].hips));
    }
    clip.sheets.push_back(std::move(sheet));
    return clip;
}

}  // namespace

std::vector<ClipData> make_person_clips(const PersonFrame& frame) {
    constexpr int kIdleKeys = 16;
    constexpr float kIdleTime = 8;
    std::vector<KeyPose> idle;
    for (int i = 0; i <= kIdleKeys; ++i) {
        idle.push_back(standing(frame, 4 * kPi * static_cast<float>(i) / kIdleKeys));
    }
    const auto held = [&](const char* name, const KeyPose& pose) {
        return make_clip(name, 1, {pose, pose}, frame);
    };
    return {
        make_clip("idle", kIdleTime, idle, frame),
        held("arms_up", arms_up(frame)),
        held("sit", sitting(frame)),
        held("squat", squatting(frame)),
        held("fist", fists(frame)),
        held("palms_up", palms_up(frame))};
}

}  // namespace limn
