#include "systems/animation/graph/root_motion.h"

#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_system.h"

#include <algorithm>
#include <cmath>

// Techniques: char.blend

namespace limn {

namespace {

constexpr int kMaxCycles = 256;  ///< in one step

/// By the angle `yaw` about y: x toward -z.
Vec2 turned_by(const Vec2& p, float yaw) {
    const float s = std::sin(yaw);
    const float c = std::cos(yaw);
    return {c * p.x + s * p.y, c * p.y - s * p.x};
}

float heading_of(const Quat& rest, const Quat& rotation) {
    const Quat turn = rotation * glm::conjugate(rest);
    return 2.0f * std::atan2(turn.w < 0.0f ? -turn.y : turn.y, std::abs(turn.w));
}

/// Where the root joint is at a time of a clip, relative to the rest pose.
GroundMove root_at(const MotionContext& context, const ClipData& clip, float time) {
    thread_local MotionPose pose;
    pose.weights.assign(context.plan.morphs, 0.0f);
    sample_pose(context.skeleton, &clip, time, pose.joints, pose.weights);
    const Vec3& rest = context.skeleton.rest.translations[0];
    const Vec3& root = pose.joints.translations[0];
    const float yaw = heading_of(context.skeleton.rest.rotations[0], pose.joints.rotations[0]);
    return {Vec2(root.x, root.z) - turned_by({rest.x, rest.z}, yaw), yaw};
}

GroundMove clip_move(
    const MotionContext& context, const ClipCycle& cycle, const ClipData& clip, bool loop,
    float from, float to) {
    const GroundMove first = root_at(context, clip, time_at(cycle, from, loop));
    const GroundMove last = root_at(context, clip, time_at(cycle, to, loop));
    const int cycles = loop ? static_cast<int>(std::floor(to) - std::floor(from)) : 0;
    if (cycles == 0) {
        return compose(inverse(first), last);
    }
    const GroundMove begin = root_at(context, clip, 0.0f);
    const GroundMove end = root_at(context, clip, clip.duration);
    const GroundMove whole = compose(inverse(begin), end);
    const GroundMove turn = cycles > 0 ? whole : inverse(whole);
    GroundMove move = compose(inverse(first), begin);
    for (int i = 0; i < std::min(std::abs(cycles), kMaxCycles); ++i) {
        move = compose(move, turn);
    }
    return compose(move, compose(inverse(begin), last));
}

}  // namespace

GroundMove compose(const GroundMove& a, const GroundMove& b) {
    return {a.way + turned_by(b.way, a.yaw), a.yaw + b.yaw};
}

GroundMove inverse(const GroundMove& move) {
    return {-turned_by(move.way, -move.yaw), -move.yaw};
}

void remove_root_motion(const SkeletonData& skeleton, LocalPose& pose) {
    const float yaw = heading_of(skeleton.rest.rotations[0], pose.rotations[0]);
    pose.rotations[0] = rotation_about({0, 1, 0}, -yaw) * pose.rotations[0];
    pose.translations[0].x = skeleton.rest.translations[0].x;
    pose.translations[0].z = skeleton.rest.translations[0].z;
}

GroundMove root_move(const MotionContext& context, std::uint32_t state, const PhaseStep& step) {
    GroundMove sum;
    if (state >= context.graph.states.size() || context.skeleton.joints.empty()) {
        return sum;
    }
    const GraphState& data = context.graph.states[state];
    const MotionPlan::State& plan = context.plan.states[state];
    const ClipWeights weights = state_weights(context, state);
    for (std::size_t i = 0; i < plan.cycles.size(); ++i) {
        if (!(weights[i] > 0.0f) || plan.fits[i] == 0) {
            continue;
        }
        const ClipCycle& cycle = plan.cycles[i];
        const GroundMove move = clip_move(
            context, cycle, context.assets.clips[data.clips[i].clip.index], data.loop,
            cycle_position(cycle, step.from, data.loop),
            cycle_position(cycle, step.to, data.loop) + step.cycles);
        sum.way += weights[i] * context.scale * move.way;
        sum.yaw += weights[i] * move.yaw;
    }
    return sum;
}

}  // namespace limn
