#include "systems/animation/ik/joint_limits.h"

#include <algorithm>

// Techniques: char.ik-joint-limits

namespace limn {

void find_comfort_step(
    const JointTree& tree, const JointState& state, float gain, std::span<float> step) {
    for (std::size_t i = 0; i < tree.axes.size(); ++i) {
        const JointAxis& axis = tree.axes[i];
        const float middle = axis.kind == AxisKind::Free ? 0.0f : axis.middle;
        step[i] = -2 * gain * axis.stiffness * (axis_value(tree, state, i) - middle);
    }
}

bool clamp_to_limits(const JointTree& tree, JointState& state) {
    bool any = false;
    for (std::size_t i = 0; i < tree.axes.size(); ++i) {
        if (tree.axes[i].kind != AxisKind::Free) {
            const auto [low, high] = axis_limits(tree.axes[i]);
            const float clamped = std::clamp(state.values[i], low, high);
            any |= clamped != state.values[i];
            state.values[i] = clamped;
        }
    }
    return any;
}

bool is_within_limits(const JointTree& tree, const JointState& state, float tolerance) {
    for (std::size_t i = 0; i < tree.axes.size(); ++i) {
        const auto [low, high] = axis_limits(tree.axes[i]);
        const bool is_inside =
            state.values[i] >= low - tolerance && state.values[i] <= high + tolerance;
        if (tree.axes[i].kind != AxisKind::Free && !is_inside) {
            return false;
        }
    }
    return true;
}

bool is_blocked(const JointAxis& axis, float value, float step) {
    if (axis.kind == AxisKind::Free) {
        return false;
    }
    const auto [low, high] = axis_limits(axis);
    return (value <= low && step < 0) || (value >= high && step > 0);
}

}  // namespace limn
