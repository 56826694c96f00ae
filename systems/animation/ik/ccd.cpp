#include "systems/animation/ik/ccd.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_limits.h"
#include "systems/animation/ik/turn_toward.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.ik-ccd

namespace limn {
namespace {

constexpr float kBend = 0.1f;      // of a stalled chain [rad]
constexpr float kStalled = 1e-5f;  // progress of a pass, relative to the distance

/// One pass; returns where the effector is then.
Vec3 turn_all(
    const JointTree& tree, const JointFrames& frames, const Effector& effector, const Vec3& goal,
    const TurnOptions& options, JointState& state) {
    Vec3 tip = effector_position(frames, effector);
    for (std::int32_t joint = effector.joint; joint >= 0; joint = tree.parents[joint]) {
        tip =
            turn_toward(tree, frames, static_cast<std::uint16_t>(joint), tip, goal, options, state);
    }
    return tip;
}

/// Bends all joints above the effector, free ones about some perpendicular of the way to it.
void bend_chain(
    const JointTree& tree, const JointFrames& frames, const Effector& effector, JointState& state) {
    const Vec3 tip = effector_position(frames, effector);
    for (std::int32_t joint = effector.joint; joint >= 0; joint = tree.parents[joint]) {
        const AxisRange range = axes_of(tree, static_cast<std::uint16_t>(joint));
        for (std::size_t i = range.first; i < range.last; ++i) {
            if (tree.axes[i].kind == AxisKind::Hinge) {
                state.values[i] += kBend;
            }
        }
        if (range.first < range.last && tree.axes[range.first].kind == AxisKind::Free) {
            const Vec3 way =
                glm::conjugate(frames.rotations[joint]) * (tip - frames.positions[joint]);
            const Vec3 axis = any_perpendicular(normalize_or(way, Vec3(0, 1, 0)));
            state.turns[joint] =
                normalize_or_identity(state.turns[joint] * rotation_about(axis, kBend));
        }
    }
}

}  // namespace

IkResult solve_ccd(
    const JointTree& tree, const Effector& effector, const Vec3& goal, const CcdOptions& options,
    JointState& state) {
    if (!std::isfinite(glm::dot(goal, goal)) || tree.size() == 0) {
        return {INFINITY, 0, false};
    }
    thread_local JointFrames frames;
    thread_local JointState best;
    const TurnOptions turns = {options.max_angle, options.limits};
    IkResult result;
    find_frames(tree, state, frames);
    float distance = glm::distance(effector_position(frames, effector), goal);
    best = state;
    float best_distance = distance;
    bool is_bent = false;
    while (result.iterations < options.passes && distance > options.tolerance) {
        ++result.iterations;
        turn_all(tree, frames, effector, goal, turns, state);
        find_frames(tree, state, frames);
        const float before = distance;
        distance = glm::distance(effector_position(frames, effector), goal);
        if (distance < best_distance) {
            best = state;
            best_distance = distance;
        }
        if (before - distance <= kStalled * before && !is_bent) {
            bend_chain(tree, frames, effector, state);
            if (options.limits) {
                clamp_to_limits(tree, state);
            }
            find_frames(tree, state, frames);
            distance = glm::distance(effector_position(frames, effector), goal);
            is_bent = true;
        }
    }
    state = best;
    result.distance = best_distance;
    result.is_reached = best_distance <= options.tolerance;
    return result;
}

}  // namespace limn
