#pragma once

#include "systems/animation/ik/joint_tree.h"

#include <span>

namespace limn {

// Inverse kinematics by penalties: instead of one exact goal, any number of soft ones at any joints
// of a body,
//
//     E = sum of k_i |f_i(theta) - g_i|^2 + sum of alpha_j (theta_j - middle_j)^2,
//
// minimized by the Levenberg-Marquardt method. Goals that contradict one another share the error by
// their weights. Finds a local minimum.
// Techniques: char.ik-penalty

struct PenaltyGoal {
    Effector effector;
    Vec3 position = {0, 0, 0};
    float weight = 1.0f;  ///< k, >= 0
};

struct PenaltyOptions {
    int iterations = 16;
    float stiffness = 1e-4f;  ///< factor on the stiffness of the axes: alpha_j [m^2/rad^2]
    float tolerance = 1e-6f;  ///< relative progress at which it stops
    bool limits = true;
};

struct PenaltyResult {
    float before = 0.0f;  ///< E
    float after = 0.0f;   ///< never more than before
    int iterations = 0;
};

[[nodiscard]] float penalty_of(
    const JointTree& tree, const JointState& state, std::span<const PenaltyGoal> goals,
    float stiffness);

/// Goals that are not finite, or have no weight, are left out.
PenaltyResult minimize_penalty(
    const JointTree& tree, std::span<const PenaltyGoal> goals, const PenaltyOptions& options,
    JointState& state);

}  // namespace limn
