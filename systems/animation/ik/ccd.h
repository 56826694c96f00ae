#pragma once

#include "systems/animation/ik/iterate_ik.h"

namespace limn {

// Cyclic coordinate descent: from the tip to the base, each joint turns so that the effector points
// at the goal. No matrices. It favors the joints near the tip and curls; `max_angle` spreads a turn
// over more joints.
// After L. Wang, C. Chen, "A Combined Optimization Method for Solving the Inverse Kinematics
// Problem of Mechanical Manipulators", 1991.
// Techniques: char.ik-ccd

struct CcdOptions {
    int passes = 32;
    float max_angle = kPi;    ///< per joint and pass [rad]
    float tolerance = 1e-3f;  ///< [m]
    bool limits = true;
};

/// No pass moves the effector away from the goal. A chain that points at or away from a goal in
/// reach is bent a little first, since no turn of a single joint would bring it closer.
IkResult solve_ccd(
    const JointTree& tree, const Effector& effector, const Vec3& goal, const CcdOptions& options,
    JointState& state);

}  // namespace limn
