#include "systems/animation/ik/turn_toward.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/elbow_circle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.ik-ccd

namespace limn {
namespace {

/// The rotation with its angle limited to `max_angle`, then scaled by `share`.
Quat limit_rotation(const Quat& rotation, float max_angle, float share) {
    const Vec3 half = log_rotation(rotation.w < 0 ? -rotation : rotation);
    const float angle = 2 * glm::length(half);
    const float kept = std::min(angle, max_angle) * share;
    return angle > 1e-12f ? exp_rotation(half * (kept / angle)) : Quat(1, 0, 0, 0);
}

/// Angle about the axis from the direction of one point to that of another, seen along it.
float angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
    const Vec3 a = from - glm::dot(from, axis) * axis;
    const Vec3 b = to - glm::dot(to, axis) * axis;
    const float size = glm::dot(a, a) * glm::dot(b, b);
    return size > 1e-24f ? std::atan2(glm::dot(axis, glm::cross(a, b)), glm::dot(a, b)) : 0.0f;
}

/// `value` + `step`, within the limits. A value beyond them stays, or moves back.
float limited(const JointAxis& axis, float value, float step) {
    const auto [low, high] = axis_limits(axis);
    return std::clamp(value + step, low, high);
}

}  // namespace

Vec3 turn_toward(
    const JointTree& tree, const JointFrames& frames, std::uint16_t joint, const Vec3& point,
    const Vec3& goal, const TurnOptions& options, JointState& state) {
    Vec3 at = point;
    const AxisRange range = axes_of(tree, joint);
    for (std::size_t i = range.last; i-- > range.first;) {
        const JointAxis& axis = tree.axes[i];
        const float share = std::clamp(axis.weight, 0.0f, 1.0f);
        const Vec3& direction = frames.axes[i];
        const Vec3& center = frames.centers[i];
        if (axis.kind == AxisKind::Free) {  // all three at once
            const Quat shortest = rotation_between(at - center, goal - center);
            const Quat turn = limit_rotation(shortest, options.max_angle, share);
            const Quat& rotation = frames.rotations[joint];
            state.turns[joint] = normalize_or_identity(
                state.turns[joint] * glm::conjugate(rotation) * turn * rotation);
            at = center + turn * (at - center);
            break;
        }
        float step = axis.kind == AxisKind::Slide
                         ? glm::dot(goal - at, direction)
                         : std::clamp(
                             angle_about(direction, at - center, goal - center), -options.max_angle,
                             options.max_angle);
        const float value = options.limits ? limited(axis, state.values[i], share * step)
                                           : state.values[i] + share * step;
        step = value - state.values[i];
        state.values[i] = value;
        at = axis.kind == AxisKind::Slide
                 ? at + step * direction
                 : center + rotation_about(direction, step) * (at - center);
    }
    return at;
}

}  // namespace limn
