#pragma once

#include "systems/animation/ik/chain_jacobian.h"

#include <optional>

namespace limn {

// Differential inverse kinematics: small moves of the effector toward its goal, each by a step of
// the axes from the pseudo-inverse of the Jacobian, which is valid only for small moves. The
// effector is where forward kinematics says, never where the linear model expected it: a move whose
// tracking error |f(theta + step) - f(theta) - J step| is too large, or that does not bring the
// effector closer, is halved and tried again.
//
// Axes at their limits are taken out of the Jacobian while a step would push them further, so that
// the others do the work. The null space of the step pulls stiff axes to their middle. Weights of
// axes scale their share of the step: a limb of low weight lags behind, with a fixed number of
// iterations per step of time. Far from singular poses, with full steps, a limb of weight w has
// (1 - w)^k of its distance left after k iterations.
// After A. Watt, F. Policarpo (2005), appendix 9.1; the pseudo-code printed there neither updates
// theta nor measures the effector.
// Techniques: char.ik-iterate, char.ik-joint-limits, char.ik-weights

struct IkGoal {
    Vec3 position = {0, 0, 0};
    std::optional<Quat> rotation = {};
};

struct IkOptions {
    int iterations = 64;
    float step = 0.05f;       ///< longest move per iteration, relative to the length of the chain
    float tracking = 0.1f;    ///< largest tracking error, relative to the move; 0: not checked
    float tolerance = 1e-3f;  ///< distance to the goal at which it is reached [m]
    float damping = 0.02f;    ///< close to singular poses, relative to the length of the chain
    float comfort = 0.0f;     ///< gain of the pull to the middle, 0 .. 0.5
    bool limits = true;
};

struct IkResult {
    float distance = 0.0f;  ///< from the effector to its goal [m]
    int iterations = 0;
    bool is_reached = false;
};

/// Moves the effector toward the goal. With a rotation, distances are of both, an angle counting as
/// its arc at 0.3 of the chain's length. Leaves the state unchanged for goals that are not finite.
IkResult iterate_ik(
    const JointTree& tree, const Effector& effector, const IkGoal& goal, const IkOptions& options,
    JointState& state);

}  // namespace limn
