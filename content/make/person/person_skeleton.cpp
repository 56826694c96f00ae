#include "content/make/person/person_skeleton.h"

#include "content/make/models/rigid_parts.h"
#include "ecs/base/rotation.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

// Techniques: char.skeleton-hierarchy, char.ik-joint-limits

namespace limn {

namespace {

constexpr float kCrown = 0.150f;  ///< above the origin of a head [m]

constexpr std::array<const char*, kMiddleJoints> kMiddleNames = {
    "Hips", "Spine", "Chest", "UpperChest", "Neck", "Head", "LeftEye", "RightEye"};
constexpr std::array<std::int16_t, kTrunkJoints> kTrunkParents = {-1, 0, 1, 2, 3, 4};

constexpr std::array<const char*, kSideJoints> kSideNames = {
    "Shoulder", "UpperArm",      "Forearm",      "Thigh",      "Shin",    "Foot",    "Toes",
    "Hand",     "UpperArmTwist", "ForearmTwist", "ThighTwist", "Thumb1",  "Thumb2",  "Thumb3",
    "Index1",   "Index2",        "Index3",       "Middle1",    "Middle2", "Middle3", "Ring1",
    "Ring2",    "Ring3",         "Little1",      "Little2",    "Little3"};

/// Where the bones of index to little finger begin, from the wrist: along the hand, to the thumb,
/// to the back of the hand; and how far they are spread toward the thumb [rad].
struct Knuckle {
    Vec3 place;
    float spread;
};
constexpr std::array<Knuckle, 4> kKnuckles = {{
    {{0.087f, 0.0295f, 0.003f}, 0.07f},
    {{0.090f, 0.0095f, 0.005f}, 0.015f},
    {{0.085f, -0.0105f, 0.004f}, -0.045f},
    {{0.077f, -0.0285f, 0.0f}, -0.12f},
}};
constexpr std::array<float, 3> kRestCurl = {0.2f, 0.52f, 0.68f};  ///< from the palm [rad]

LimbAxes limb_axes(const Vec3& along) {
    LimbAxes axes;
    axes.along = glm::normalize(along);
    axes.thumb = glm::normalize(Vec3(0, 0, 1) - axes.along.z * axes.along);
    axes.back = glm::cross(axes.thumb, axes.along);
    return axes;
}

void place_fingers(PersonFrame& frame) {
    const LimbAxes& hand = frame.hand;
    const Vec3 wrist = frame.at(SideJoint::Hand);
    const auto put = [&](int finger, int bone, const Vec3& p) {
        frame.joints[joint_index(finger_joint(finger, bone), 1)] = p;
    };
    for (int finger = 1; finger <= 4; ++finger) {
        const Knuckle& knuckle = kKnuckles[finger - 1];
        Vec3 at = wrist + knuckle.place.x * hand.along + knuckle.place.y * hand.thumb
                  + knuckle.place.z * hand.back;
        const std::array<float, 3> lengths = finger_lengths(finger);
        for (int bone = 0; bone < 3; ++bone) {
            put(finger, bone, at);
            const Vec3 flat = hand.along + knuckle.spread * hand.thumb;
            at += lengths[bone]
                  * glm::normalize(
                      std::cos(kRestCurl[bone]) * flat - std::sin(kRestCurl[bone]) * hand.back);
        }
    }
    Vec3 at = wrist + 0.02f * hand.along + 0.02f * hand.thumb - 0.006f * hand.back;
    const std::array<float, 3> lengths = finger_lengths(0);
    constexpr std::array<Vec3, 3> kThumb = {
        {{0.72f, 0.58f, -0.38f}, {0.82f, 0.48f, -0.32f}, {0.92f, 0.34f, -0.26f}}};
    for (int bone = 0; bone < 3; ++bone) {
        put(0, bone, at);
        const Vec3& way = kThumb[bone];
        at += lengths[bone]
              * glm::normalize(way.x * hand.along + way.y * hand.thumb + way.z * hand.back);
    }
}

void place_arm(PersonFrame& frame) {
    const auto put = [&](SideJoint joint, const Vec3& p) {
        frame.joints[joint_index(joint, 1)] = p;
    };
    frame.upper_arm_length = glm::mix(0.282f, 0.292f, frame.man);
    frame.forearm_length = glm::mix(0.243f, 0.256f, frame.man);
    frame.upper_arm = limb_axes({0.707f, -0.707f, -0.03f});
    frame.forearm = limb_axes({0.690f, -0.715f, 0.10f});
    frame.hand = limb_axes({0.670f, -0.735f, 0.10f});
    const Vec3 shoulder(glm::mix(0.160f, 0.178f, frame.man), 1.408f, -0.012f);
    put(SideJoint::Shoulder, {0.025f, 1.425f, 0.02f});
    put(SideJoint::UpperArm, shoulder);
    put(SideJoint::UpperArmTwist, shoulder);
    const Vec3 elbow = shoulder + frame.upper_arm_length * frame.upper_arm.along;
    put(SideJoint::Forearm, elbow);
    put(SideJoint::ForearmTwist, elbow + 0.5f * frame.forearm_length * frame.forearm.along);
    put(SideJoint::Hand, elbow + frame.forearm_length * frame.forearm.along);
    place_fingers(frame);
}

void place_leg(PersonFrame& frame) {
    const auto put = [&](SideJoint joint, const Vec3& p) {
        frame.joints[joint_index(joint, 1)] = p;
    };
    const Vec3 hip(0.090f, 0.925f, 0.0f);
    put(SideJoint::Thigh, hip);
    put(SideJoint::ThighTwist, hip);
    put(SideJoint::Shin, {0.093f, 0.495f, 0.006f});
    put(SideJoint::Foot, {0.096f, 0.088f, -0.028f});
    put(SideJoint::Toes, {0.106f, 0.028f, 0.105f});
}

SideJoint side_parent(std::size_t joint) {
    constexpr std::array<SideJoint, kSideJoints> kParents = {
        SideJoint::Shoulder, SideJoint::Shoulder, SideJoint::UpperArm, SideJoint::Thigh,
        SideJoint::Thigh,    SideJoint::Shin,     SideJoint::Foot,     SideJoint::Forearm,
        SideJoint::UpperArm, SideJoint::Forearm,  SideJoint::Thigh,    SideJoint::Hand,
        SideJoint::Thumb1,   SideJoint::Thumb2,   SideJoint::Hand,     SideJoint::Index1,
        SideJoint::Index2,   SideJoint::Hand,     SideJoint::Middle1,  SideJoint::Middle2,
        SideJoint::Hand,     SideJoint::Ring1,    SideJoint::Ring2,    SideJoint::Hand,
        SideJoint::Little1,  SideJoint::Little2};
    return kParents[joint];
}

std::int32_t parent_of(const PersonJointPlace& joint) {
    if (joint.side == 0) {
        return joint.own < kTrunkJoints ? kTrunkParents[joint.own] : joint_index(PersonJoint::Head);
    }
    if (joint.own == static_cast<std::size_t>(SideJoint::Shoulder)) {
        return joint_index(PersonJoint::UpperChest);
    }
    if (joint.own == static_cast<std::size_t>(SideJoint::Thigh)) {
        return joint_index(PersonJoint::Hips);
    }
    return joint_index(side_parent(joint.own), joint.side);
}

std::string name_of(const PersonJointPlace& joint) {
    if (joint.side == 0) {
        return kMiddleNames[joint.own];
    }
    return std::string(joint.side > 0 ? "Left" : "Right") + kSideNames[joint.own];
}

/// Collects limits of joints; angles in degrees from the rest pose.
class FreedomList {
  public:
    explicit FreedomList(SkeletonData& skeleton) : skeleton_(skeleton) {}

    void add(PersonJoint joint, const Vec3& axis, float min, float max, float stiffness = 0.4f) {
        add(joint_index(joint), axis, min, max, stiffness);
    }

    /// Both sides: a rotation is mirrored by mirroring its axis as a pseudovector.
    void add(SideJoint joint, const Vec3& axis, float min, float max, float stiffness = 0.2f) {
        add(joint_index(joint, 1), axis, min, max, stiffness);
        add(joint_index(joint, -1), {axis.x, -axis.y, -axis.z}, min, max, stiffness);
    }

    void finish() {
        std::stable_sort(
            skeleton_.freedoms.begin(), skeleton_.freedoms.end(),
            [](const JointFreedom& a, const JointFreedom& b) { return a.joint < b.joint; });
    }

  private:
    void add(std::uint16_t joint, const Vec3& axis, float min, float max, float stiffness) {
        skeleton_.freedoms.push_back(
            {.joint = joint,
             .axis = glm::normalize(axis),
             .min = radians(min),
             .max = radians(max),
             .middle = radians(std::clamp(0.0f, min, max)),
             .stiffness = stiffness});
    }

    SkeletonData& skeleton_;
};

void add_limits_of_back(FreedomList& limits) {
    for (const PersonJoint joint :
         {PersonJoint::Spine, PersonJoint::Chest, PersonJoint::UpperChest}) {
        limits.add(joint, {0, 1, 0}, -16, 16);
        limits.add(joint, {1, 0, 0}, -12, 28);
        limits.add(joint, {0, 0, 1}, -12, 12);
    }
    for (const PersonJoint joint : {PersonJoint::Neck, PersonJoint::Head}) {
        limits.add(joint, {0, 1, 0}, -40, 40);
        limits.add(joint, {1, 0, 0}, -30, 25);
        limits.add(joint, {0, 0, 1}, -20, 20);
    }
    for (const PersonJoint joint : {PersonJoint::LeftEye, PersonJoint::RightEye}) {
        limits.add(joint, {0, 1, 0}, -35, 35, 0);
        limits.add(joint, {1, 0, 0}, -25, 30, 0);
    }
}

void add_limits_of_arm(FreedomList& limits, const PersonFrame& frame) {
    limits.add(SideJoint::Shoulder, {0, 0, 1}, -6, 40, 0.5f);
    limits.add(SideJoint::Shoulder, {0, 1, 0}, -16, 12, 0.5f);
    limits.add(SideJoint::UpperArm, {0, 1, 0}, -125, 45);
    limits.add(SideJoint::UpperArm, {0, 0, 1}, -50, 120);
    limits.add(SideJoint::UpperArm, frame.upper_arm.along, -80, 80);
    limits.add(SideJoint::Forearm, -frame.forearm.back, -6, 140);
    limits.add(SideJoint::Forearm, frame.forearm.along, -80, 80);
    limits.add(SideJoint::Hand, -frame.hand.thumb, -65, 75);
    limits.add(SideJoint::Hand, frame.hand.back, -28, 20);
    for (int finger = 1; finger <= 4; ++finger) {
        const auto bone = [finger](int k) { return finger_joint(finger, k); };
        limits.add(bone(0), -frame.hand.thumb, -35, 80);
        limits.add(bone(0), frame.hand.back, -14, 14);
        limits.add(bone(1), -frame.hand.thumb, -18, 85);
        limits.add(bone(2), -frame.hand.thumb, -8, 70);
    }
    const Vec3 thumb_axis = glm::normalize(glm::cross(
        frame.at(SideJoint::Thumb2) - frame.at(SideJoint::Thumb1),
        -0.7f * frame.hand.thumb - 0.5f * frame.hand.back));
    limits.add(SideJoint::Thumb1, thumb_axis, -20, 40);
    limits.add(SideJoint::Thumb1, frame.hand.thumb, -25, 25);
    limits.add(SideJoint::Thumb2, thumb_axis, -10, 50);
    limits.add(SideJoint::Thumb3, thumb_axis, -15, 75);
}

void add_limits_of_leg(FreedomList& limits) {
    limits.add(SideJoint::Thigh, {1, 0, 0}, -120, 22);
    limits.add(SideJoint::Thigh, {0, 0, 1}, -22, 45);
    limits.add(SideJoint::Thigh, {0, 1, 0}, -40, 42);
    limits.add(SideJoint::Shin, {1, 0, 0}, -4, 145);
    limits.add(SideJoint::Foot, {1, 0, 0}, -20, 45);
    limits.add(SideJoint::Foot, {0, 0, 1}, -18, 28);
    limits.add(SideJoint::Toes, {1, 0, 0}, -60, 25);
}

}  // namespace

PersonJointPlace person_joint_place(std::size_t joint) {
    if (joint < kTrunkJoints) {
        return {joint, 0};
    }
    const std::size_t pair = joint - kTrunkJoints;
    return pair < 2 * kSideJoints ? PersonJointPlace{pair / 2, pair % 2 == 0 ? 1 : -1}
                                  : PersonJointPlace{joint - 2 * kSideJoints, 0};
}

std::int32_t person_joint_parent(std::size_t joint) {
    return parent_of(person_joint_place(joint));
}

std::array<float, 3> finger_lengths(int finger) {
    constexpr std::array<std::array<float, 3>, 5> kLengths = {{
        {0.044f, 0.033f, 0.028f},
        {0.044f, 0.025f, 0.022f},
        {0.048f, 0.029f, 0.023f},
        {0.044f, 0.027f, 0.023f},
        {0.035f, 0.020f, 0.020f},
    }};
    return kLengths[finger];
}

PersonFrame measure_person(const PersonShape& shape) {
    PersonFrame frame;
    frame.look = choose_person(shape);
    frame.scale = frame.look.shape.height / kReferenceHeight;
    frame.child = frame.look.child;
    frame.infant = frame.look.infant;
    frame.man = std::lerp(0.5f + 0.5f * frame.look.sex, 0.15f, frame.child);
    frame.build = frame.look.shape.build;
    frame.head_scale = std::lerp(1.0f / std::sqrt(frame.scale), 1.0f, std::min(frame.infant, 1.0f));
    frame.head_origin = {0, kReferenceHeight - kCrown * frame.head_scale, 0.018f};
    const auto put = [&](PersonJoint joint, const Vec3& p) {
        frame.joints[joint_index(joint)] = p;
    };
    put(PersonJoint::Hips, {0, 0.955f, -0.005f});
    put(PersonJoint::Spine, {0, 1.055f, -0.015f});
    put(PersonJoint::Chest, {0, 1.165f, -0.025f});
    put(PersonJoint::UpperChest, {0, 1.285f, -0.03f});
    put(PersonJoint::Neck, {0, 1.455f, -0.03f});
    put(PersonJoint::Head, {0, 1.55f, -0.005f});
    const Vec3 eye = frame.head_scale * Vec3(0.0315f, 0.035f, 0.0792f);
    put(PersonJoint::LeftEye, frame.head_origin + eye);
    put(PersonJoint::RightEye, frame.head_origin + eye * Vec3(-1, 1, 1));
    place_arm(frame);
    place_leg(frame);
    for (std::size_t i = 0; i < kSideJoints; ++i) {
        const auto joint = static_cast<SideJoint>(i);
        frame.joints[joint_index(joint, -1)] = frame.at(joint) * Vec3(-1, 1, 1);
    }
    return frame;
}

SkeletonData make_person_skeleton(const PersonFrame& frame) {
    SkeletonData skeleton;
    for (std::size_t joint = 0; joint < kPersonJoints; ++joint) {
        const PersonJointPlace place = person_joint_place(joint);
        const std::int32_t parent = parent_of(place);
        const Vec3 origin = parent < 0 ? Vec3(0) : frame.joints[parent];
        add_rigid_joint(
            skeleton, name_of(place), parent, frame.scale * (frame.joints[joint] - origin));
    }
    FreedomList limits(skeleton);
    add_limits_of_back(limits);
    add_limits_of_arm(limits, frame);
    add_limits_of_leg(limits);
    limits.finish();
    return skeleton;
}

}  // namespace limn
