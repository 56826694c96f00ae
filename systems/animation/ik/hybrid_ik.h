#pragma once

#include "systems/animation/ik/elbow_circle.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/penalty_ik.h"

#include <span>

namespace limn {

// Hybrid inverse kinematics of a whole body: hips and spine move iteratively until every limb can
// reach its goal, then each limb reaches it exactly, in closed form, with the swivel of its elbow
// or knee that suits its limits best. The cost is linear in the number of limbs.
// After J. Lee, S. Y. Shin, "A Hierarchical Approach to Interactive Motion Editing for Human-like
// Figures", 1999.
// Techniques: char.ik-hybrid

/// A limb of a body: three joints of the tree.
struct BodyLimb {
    std::uint16_t root = 0;    ///< shoulder or hip
    std::uint16_t middle = 0;  ///< elbow or knee
    std::uint16_t tip = 0;     ///< wrist or ankle
    Vec3 goal = {0, 0, 0};
    LimbOptions options = {};
    float preference = 0.05f;  ///< of the current swivel over one that suits the limits better
};

struct HybridOptions {
    PenaltyOptions spine = {.iterations = 48};
    bool limits = true;  ///< choose swivels by the limits of the limbs' roots
};

/// Moves the axes of the tree that are not below the root of a limb, then the limbs. Returns the
/// largest distance that is left between a tip and its goal [m].
float solve_hybrid(
    const JointTree& tree, std::span<const BodyLimb> limbs, const HybridOptions& options,
    JointState& state);

/// Reaches with one limb in closed form.
void reach_with_limb(
    const JointTree& tree, const BodyLimb& limb, bool limits, JointFrames& frames,
    JointState& state);

/// The swivel for which the limb's root violates its limits least, close to the current one [rad].
[[nodiscard]] float choose_swivel(
    const JointTree& tree, const BodyLimb& limb, const JointFrames& frames,
    const JointState& state);

}  // namespace limn
