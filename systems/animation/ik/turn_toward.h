#pragma once

#include "systems/animation/ik/joint_tree.h"

namespace limn {

// The best turn of a single joint: the step of cyclic coordinate descent, and how a joint with axes
// follows positions.
// Techniques: char.ik-ccd

struct TurnOptions {
    float max_angle = kPi;  ///< per axis [rad]
    bool limits = true;
};

/// Turns the joint, about one axis after the other from the last to the first, so that a point that
/// moves with it comes as close to `goal` as its axes, their limits and weights allow; slides move.
/// Returns where the point is then. `frames`: of the joint before the turn; not updated.
Vec3 turn_toward(
    const JointTree& tree, const JointFrames& frames, std::uint16_t joint, const Vec3& point,
    const Vec3& goal, const TurnOptions& options, JointState& state);

}  // namespace limn
