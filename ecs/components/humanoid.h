#pragma once

#include "ecs/components/skeleton.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace limn {

// Which joint of a skeleton is which part of a person, so that walking, retargeting and looking at
// things work for skeletons from different programs.

/// Left is the person's own left.
enum class BodyPart : std::uint8_t {
    Hips,
    Spine,  ///< the lowest joint of the back
    Chest,  ///< the highest joint of the back; may be Spine
    Neck,
    Head,
    LeftShoulder,  ///< collar bone
    LeftUpperArm,
    LeftForearm,
    LeftHand,
    LeftThigh,
    LeftShin,
    LeftFoot,
    LeftToes,
    RightShoulder,
    RightUpperArm,
    RightForearm,
    RightHand,
    RightThigh,
    RightShin,
    RightFoot,
    RightToes,
};
inline constexpr std::size_t kBodyParts = 21;

/// Index of the joint of each part; kNoJoint where the skeleton lacks it.
struct BodyJoints {
    static constexpr std::uint16_t kNoJoint = 0xffff;
    std::array<std::uint16_t, kBodyParts> joints = {};

    [[nodiscard]] std::uint16_t operator[](BodyPart part) const {
        return joints[static_cast<std::size_t>(part)];
    }
    [[nodiscard]] bool has(BodyPart part) const { return (*this)[part] != kNoJoint; }
};

/// Finds the parts by the names of the joints, in the customs of BVH files, Mixamo, Blender, VRM
/// and MakeHuman: "LeftUpLeg", "mixamorig:LeftUpLeg", "thigh.L", "J_Bip_L_UpperLeg",
/// "upperleg01.L". Case and separators do not matter.
[[nodiscard]] BodyJoints find_body_joints(const SkeletonData& skeleton);

}  // namespace limn
