#pragma once

#include "systems/animation/ik/iterate_ik.h"

namespace limn {

// Forward and backward reaching inverse kinematics: positions of the joints are dragged along the
// chain, from the goal to the base and back, each at its distance from the next one. Few cheap
// iterations, and bends spread over the chain. On the way back joints with axes turn as far as
// these and their limits allow; since positions know nothing of axes, a pass of cyclic coordinate
// descent follows in chains that have such joints.
// After A. Aristidou, J. Lasenby, "FABRIK: A Fast, Iterative Solver for the Inverse Kinematics
// Problem", 2011.
// Techniques: char.ik-ccd

struct FabrikOptions {
    int iterations = 16;
    float tolerance = 1e-3f;  ///< [m]
    bool limits = true;
};

/// Reaches with the joints from the base to the effector. Out of reach a chain of free joints is
/// stretched toward the goal.
IkResult solve_fabrik(
    const JointTree& tree, const Effector& effector, const Vec3& goal, const FabrikOptions& options,
    JointState& state);

}  // namespace limn
