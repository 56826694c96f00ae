#pragma once

#include "systems/animation/ik/joint_tree.h"

#include <span>

namespace limn {

// Joint limits, hard and soft: values are clamped to their ranges after each step, and drawn to the
// middle of the ranges by the gradient of H = sum of stiffness_i (theta_i - middle_i)^2, as a
// secondary task in the null space of the first one. Clamping alone may stall. A range with min >
// max is taken in ascending order.
// Techniques: char.ik-joint-limits

/// step = -gain grad H = -2 gain stiffness_i (theta_i - middle_i) per axis.
void find_comfort_step(
    const JointTree& tree, const JointState& state, float gain, std::span<float> step);

/// Clamps hinges and slides to their limits. Returns whether any was outside.
bool clamp_to_limits(const JointTree& tree, JointState& state);

/// Whether every value is within its limits, to `tolerance`.
[[nodiscard]] bool
is_within_limits(const JointTree& tree, const JointState& state, float tolerance = 1e-5f);

/// Whether the axis is at a limit, or beyond, and the step would move it further out.
[[nodiscard]] bool is_blocked(const JointAxis& axis, float value, float step);

}  // namespace limn
