#pragma once

#include "content/make/person/person_look.h"

#include <array>

namespace limn {

// Joints of a person and their rest positions: an A-pose, arms 45 degrees below the horizontal,
// palms toward the thighs, elbows, knees and fingers a little bent so that inverse kinematics knows
// which way they fold. Rest rotations are the identity. Lengths after Gordon et al.,
// "Anthropometric Survey of U.S. Army Personnel" (1989), and Greiner, "Hand Anthropometry of U.S.
// Army Personnel" (1991), rounded. Limits after Norkin and White, "Measurement of Joint Motion"
// (1985).

/// In the middle of the body.
enum class PersonJoint : std::uint16_t {
    Hips,
    Spine,
    Chest,
    UpperChest,
    Neck,
    Head,
    LeftEye,
    RightEye,
};
inline constexpr std::size_t kMiddleJoints = 8;

/// Of one side: limbs, then what is too small to be seen from far away.
enum class SideJoint : std::uint16_t {
    Shoulder,
    UpperArm,
    Forearm,
    Thigh,
    Shin,
    Foot,
    Toes,
    Hand,
    UpperArmTwist,
    ForearmTwist,
    ThighTwist,
    Thumb1,
    Thumb2,
    Thumb3,
    Index1,
    Index2,
    Index3,
    Middle1,
    Middle2,
    Middle3,
    Ring1,
    Ring2,
    Ring3,
    Little1,
    Little2,
    Little3,
};
inline constexpr std::size_t kSideJoints = 26;
inline constexpr std::size_t kPersonJoints = kMiddleJoints + 2 * kSideJoints;

// The order of the joints: trunk and head, both sides in turn, eyes. Each level of detail of the
// skeleton is its first joints.
inline constexpr std::size_t kTrunkJoints = 6;

[[nodiscard]] constexpr std::uint16_t joint_index(PersonJoint joint) {
    const auto own = static_cast<std::size_t>(joint);
    return static_cast<std::uint16_t>(own < kTrunkJoints ? own : own + 2 * kSideJoints);
}
/// `side`: +1 left, -1 right.
[[nodiscard]] constexpr std::uint16_t joint_index(SideJoint joint, int side) {
    return static_cast<std::uint16_t>(
        kTrunkJoints + 2 * static_cast<std::size_t>(joint) + (side > 0 ? 0 : 1));
}
/// `finger` 0: thumb .. 4: little finger, `bone` 0 .. 2.
[[nodiscard]] constexpr SideJoint finger_joint(int finger, int bone) {
    return static_cast<SideJoint>(static_cast<int>(SideJoint::Thumb1) + 3 * finger + bone);
}

/// Unit axes of a limb: along it, to the side of the thumb, to the back of the hand.
struct LimbAxes {
    Vec3 along = {};
    Vec3 thumb = {};
    Vec3 back = {};
};

/// The measures of one person at a height of kReferenceHeight, left side [m].
struct PersonFrame {
    PersonLook look;
    float scale = 1;       ///< from the reference height to the person's
    float man = 1;         ///< 0: a woman's proportions, 1: a man's
    float child = 0;       ///< 0: grown up, 1: a child of seven, by height or years
    float infant = 0;      ///< how far bones are from an adult's, 1: a child of four
    float build = 0;       ///< -1 .. 1
    float head_scale = 1;  ///< of the head in reference units; heads vary less than heights
    Vec3 head_origin = {};
    std::array<Vec3, kPersonJoints> joints = {};
    LimbAxes upper_arm;
    LimbAxes forearm;
    LimbAxes hand;
    float upper_arm_length = 0;
    float forearm_length = 0;

    [[nodiscard]] const Vec3& at(PersonJoint joint) const { return joints[joint_index(joint)]; }
    [[nodiscard]] const Vec3& at(SideJoint joint) const { return joints[joint_index(joint, 1)]; }
};
inline constexpr float kReferenceHeight = 1.75f;

/// A joint by its place in the order.
struct PersonJointPlace {
    std::size_t own = 0;  ///< of its enumeration
    int side = 0;         ///< +1 left, -1 right, 0 in the middle
};

[[nodiscard]] PersonJointPlace person_joint_place(std::size_t joint);

/// Index of the parent of a joint, -1 for the root.
[[nodiscard]] std::int32_t person_joint_parent(std::size_t joint);

/// Lengths of the three bones of a finger; 0: thumb, 1 .. 4: index to little finger [m].
[[nodiscard]] std::array<float, 3> finger_lengths(int finger);

/// With the proportions of an adult, also for children (person_growth.h).
[[nodiscard]] PersonFrame measure_person(const PersonShape& shape);

/// At the person's own height. `frame`: a grown_frame.
[[nodiscard]] SkeletonData make_person_skeleton(const PersonFrame& frame);

}  // namespace limn
