#include "systems/animation/ik/hybrid_ik.h"

#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

// Techniques: char.ik-hybrid

namespace limn {
namespace {

constexpr int kSwivels = 24;          // tried around the circle
constexpr int kSwivelHalvings = 6;    // of the interval around the best one
constexpr float kReachShare = 0.99f;  // of a limb's length that the spine brings goals into

constexpr float kSlackWeight = 0.01f;  // of a limb that reaches its goal already

LimbPoints points_of(const BodyLimb& limb, const JointFrames& frames) {
    return {frames.positions[limb.root], frames.positions[limb.middle], frames.positions[limb.tip]};
}

/// The axis about which the limb bends: the first one of its middle joint.
Vec3 hinge_of(const JointTree& tree, const BodyLimb& limb, const JointFrames& frames) {
    const AxisRange range = axes_of(tree, limb.middle);
    const bool is_hinge =
        range.first < range.last && tree.axes[range.first].kind == AxisKind::Hinge;
    return is_hinge ? frames.axes[range.first] : Vec3(0);
}

/// Local rotation of a joint whose rotation in the space of the tree is to become `rotation`.
Quat local_of(
    const JointTree& tree, const JointFrames& frames, std::uint16_t joint, const Quat& rotation) {
    const std::int32_t parent = tree.parents[joint];
    const Quat& before = parent < 0 ? tree.base_rotation : frames.rotations[parent];
    return glm::conjugate(before) * rotation;
}

LimbTurn
turn_of(const JointTree& tree, const BodyLimb& limb, const JointFrames& frames, float swivel) {
    const LimbPoints now = points_of(limb, frames);
    LimbOptions options = limb.options;
    options.swivel += swivel;
    options.hinge = hinge_of(tree, limb, frames);
    return find_limb_turn(now, solve_limb(now, limb.goal, options), options.hinge);
}

bool is_below_limb(const JointTree& tree, std::span<const BodyLimb> limbs, std::int32_t joint) {
    while (joint >= 0) {
        for (const BodyLimb& limb : limbs) {
            if (joint == limb.root) {
                return true;
            }
        }
        joint = tree.parents[joint];
    }
    return false;
}

/// How far a goal is beyond the reach of its limb, as a goal for the limb's root.
PenaltyGoal pull_root(const BodyLimb& limb, const JointFrames& frames) {
    const LimbPoints now = points_of(limb, frames);
    const float reach =
        kReachShare * (glm::distance(now.root, now.middle) + glm::distance(now.middle, now.tip))
        - 2 * std::max(limb.options.softness, 0.0f);
    const Vec3 way = limb.goal - now.root;
    const float excess = std::max(0.0f, glm::length(way) - std::max(reach, 0.0f));
    return {
        {limb.root, Vec3(0)},
        now.root + excess * normalize_or(way, Vec3(0)),
        excess > 0 ? 1.0f : kSlackWeight};
}

}  // namespace

float choose_swivel(
    const JointTree& tree, const BodyLimb& limb, const JointFrames& frames,
    const JointState& state) {
    const AxisRange range = axes_of(tree, limb.root);
    thread_local JointState trial;
    trial = state;
    const auto cost = [&](float swivel) {
        const Quat upper = turn_of(tree, limb, frames, swivel).upper * frames.rotations[limb.root];
        set_local_rotation(tree, local_of(tree, frames, limb.root, upper), limb.root, trial);
        float sum = limb.preference * swivel * swivel;
        for (std::size_t i = range.first; i < range.last; ++i) {
            if (tree.axes[i].kind == AxisKind::Hinge) {
                const auto [low, high] = axis_limits(tree.axes[i]);
                const float value = trial.values[i];
                const float beyond = std::max({low - value, value - high, 0.0f});
                sum += 100 * beyond * beyond;
            }
        }
        return sum;
    };
    float best = 0;
    float least = cost(0);
    const auto improve = [&](float swivel) {
        const float at = cost(swivel);
        if (at < least) {
            least = at;
            best = swivel;
        }
    };
    float step = 2 * kPi / kSwivels;
    for (int i = 1; i <= kSwivels / 2; ++i) {
        improve(step * static_cast<float>(i));
        improve(-step * static_cast<float>(i));
    }
    for (int i = 0; i < kSwivelHalvings; ++i) {
        step *= 0.5f;
        const float center = best;
        improve(center + step);
        improve(center - step);
    }
    return best;
}

void reach_with_limb(
    const JointTree& tree, const BodyLimb& limb, bool limits, JointFrames& frames,
    JointState& state) {
    if (!is_finite(limb.goal)) {
        return;
    }
    const AxisRange range = axes_of(tree, limb.root);
    const bool has_limits =
        limits && range.first < range.last && tree.axes[range.first].kind == AxisKind::Hinge;
    const float swivel = has_limits ? choose_swivel(tree, limb, frames, state) : 0.0f;
    const LimbTurn turn = turn_of(tree, limb, frames, swivel);
    const Quat lower = turn.lower * frames.rotations[limb.middle];
    set_local_rotation(
        tree, local_of(tree, frames, limb.root, turn.upper * frames.rotations[limb.root]),
        limb.root, state);
    find_frames(tree, state, frames);
    set_local_rotation(tree, local_of(tree, frames, limb.middle, lower), limb.middle, state);
    find_frames(tree, state, frames);
}

float solve_hybrid(
    const JointTree& tree, std::span<const BodyLimb> limbs, const HybridOptions& options,
    JointState& state) {
    thread_local JointTree spine;
    thread_local JointFrames frames;
    thread_local std::vector<PenaltyGoal> goals;
    spine = tree;
    for (JointAxis& axis : spine.axes) {
        axis.weight = is_below_limb(tree, limbs, axis.joint) ? 0.0f : axis.weight;
    }
    PenaltyOptions one = options.spine;
    one.iterations = 1;
    for (int i = 0; i < options.spine.iterations; ++i) {
        find_frames(tree, state, frames);
        goals.clear();
        bool any = false;
        for (const BodyLimb& limb : limbs) {
            goals.push_back(pull_root(limb, frames));
            any |= goals.back().position != frames.positions[limb.root];
        }
        if (!any || minimize_penalty(spine, goals, one, state).iterations == 0) {
            break;
        }
    }
    find_frames(tree, state, frames);
    float farthest = 0;
    for (const BodyLimb& limb : limbs) {
        reach_with_limb(tree, limb, options.limits, frames, state);
        if (is_finite(limb.goal)) {
            farthest = std::max(farthest, glm::distance(frames.positions[limb.tip], limb.goal));
        }
    }
    return farthest;
}

}  // namespace limn
