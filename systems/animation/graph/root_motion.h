#pragma once

#include "systems/animation/graph/motion_pose.h"

namespace limn {

// Root motion: how the root joint of a clip moves over the ground moves the entity instead, and the
// joint stays above its place in the rest pose. So a transition to a clip that begins elsewhere, or
// the start of the next cycle, does not move the character.

/// A motion in the horizontal plane: turn, then shift.
struct GroundMove {
    Vec2 way = {0, 0};  ///< along x and z [m]
    float yaw = 0.0f;   ///< about y [rad]
};

/// b after a, in the frame that a leads to.
[[nodiscard]] GroundMove compose(const GroundMove& a, const GroundMove& b);
[[nodiscard]] GroundMove inverse(const GroundMove& move);

/// Puts the root joint above its place in the rest pose, heading as there.
void remove_root_motion(const SkeletonData& skeleton, LocalPose& pose);

/// How the state moves the character in a step: the mean of its clips by their weights, each exact
/// for any number of cycles. The sum of moves does not depend on the length of steps.
[[nodiscard]] GroundMove
root_move(const MotionContext& context, std::uint32_t state, const PhaseStep& step);

}  // namespace limn
