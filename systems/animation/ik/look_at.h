#pragma once

#include "ecs/components/skeleton.h"

#include <span>

namespace limn {

// Heads and eyes that look at a point. The direction is split into an angle about the up axis and
// one above the horizon, so that a head never tilts sideways; each joint from the neck to the eyes
// takes a share of what is left, within its limits.

/// One of the joints that look, from the lowest to the eyes.
struct LookJoint {
    std::uint16_t joint = 0;
    Vec3 forward = {0, 0, 1};  ///< where it looks, in its space; unit
    float share = 1.0f;        ///< of what the joints before it have left
    float max_yaw = 1.0f;      ///< from the animated pose [rad]
    float max_pitch = 0.6f;    ///< [rad]
};

/// A direction as angles: about +y from +z toward +x, and up.
struct LookAngles {
    float yaw = 0.0f;    ///< -pi .. pi [rad]
    float pitch = 0.0f;  ///< -pi / 2 .. pi / 2 [rad]
};
[[nodiscard]] LookAngles look_angles(const Vec3& direction);
[[nodiscard]] Vec3 look_direction(const LookAngles& angles);

/// Turns the joints of a pose so that the last one looks at `target`, in the space of the skeleton;
/// `weight` 0: unchanged. A target that is not finite, or at the joint: unchanged. Returns the
/// angle that is left between the last joint's direction and the target [rad].
float look_at(
    const SkeletonData& skeleton, std::span<const LookJoint> joints, const Vec3& target,
    float weight, LocalPose& pose);

}  // namespace limn
