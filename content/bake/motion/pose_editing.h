#pragma once

#include "ecs/base/math.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/skeleton.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace limn {

// Setting poses by hand (char.fk-keypose), without a window. An edit at a time between keys sets a
// key there, so that nothing that was posed is lost.

/// Keys nearer than this are the same [s].
inline constexpr float kSameKeyTime = 1e-3f;

/// Index of the key at `time`.
[[nodiscard]] std::optional<std::size_t> find_pose_key(const PoseKeys& keys, float time);

/// The pose of the keys at `time` [s]; the rest pose where they are invalid.
[[nodiscard]] LocalPose
sample_pose_keys(const SkeletonData& skeleton, const PoseKeys& keys, float time);

/// Sets the pose at `time` >= 0 [s]: inserts a key in order, or replaces the one there. Scales are
/// not kept.
void set_pose_key(PoseKeys& keys, const SkeletonData& skeleton, float time, const LocalPose& pose);

/// Removes the key at `time`; false: there is none.
bool remove_pose_key(PoseKeys& keys, float time);

/// The rotation of `joint` from its rest pose; translation likewise.
[[nodiscard]] KeyedJoint
keyed_joint(const SkeletonData& skeleton, const LocalPose& pose, std::uint16_t joint);

/// Sets the rotation of `joint` from its rest pose.
void turn_joint(
    const SkeletonData& skeleton, std::uint16_t joint, const Quat& turn, LocalPose& pose);

/// `angle` at the nearest multiple of `step`, both [rad]; 0: as it is.
[[nodiscard]] float snap_angle(float angle, float step);

/// Index of the joint of the other side, by its name: "LeftArm" and "RightArm", "arm.L" and
/// "arm.R", "arm_l" and "arm_r". A joint in the middle is its own.
[[nodiscard]] std::vector<std::uint16_t> mirrored_joints(const SkeletonData& skeleton);

/// The pose in a mirror, left and right exchanged: what each joint turns from rest, as seen in the
/// skeleton's space at rest, is mirrored at the plane x = 0. Twice is the same pose again.
[[nodiscard]] LocalPose mirror_pose(const SkeletonData& skeleton, const LocalPose& pose);

}  // namespace limn
