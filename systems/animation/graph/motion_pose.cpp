#include "systems/animation/graph/motion_pose.h"

#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/graph/inertial_offset.h"
#include "systems/animation/graph/root_motion.h"
#include "systems/animation/pose_kernels.h"
#include "systems/animation/pose_system.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.blend, char.motion-modify

namespace limn {

namespace {

constexpr float kMinTravel = 1e-4f;     ///< of a cycle [m]
constexpr float kMaxRateFactor = 4.0f;  ///< of cycles that follow the speed

/// A state, blended at this moment.
struct BlendedCycle {
    ClipWeights weights{};
    float rate = 0.0f;            ///< cycles per second; negative: backward
    std::vector<float> segments;  ///< their shares of the cycle, sum 1
};

bool is_state(const MotionContext& context, std::uint32_t state) {
    return state < context.graph.states.size();
}

/// Cycles per second.
float cycle_rate(const MotionContext& context, std::uint32_t index, const ClipWeights& weights) {
    const GraphState& state = context.graph.states[index];
    const MotionPlan::State& plan = context.plan.states[index];
    float rate = 0.0f;
    float travel = 0.0f;
    for (std::size_t i = 0; i < plan.cycles.size(); ++i) {
        const float duration = plan.cycles[i].duration;
        rate += duration > 0.0f ? weights[i] / duration : 0.0f;
        travel += weights[i] * state.clips[i].travel * context.scale;
    }
    if (state.x == GraphParameter::Speed && travel > kMinTravel) {
        const float wanted = std::abs(context.parameters.speed) / travel;
        rate = std::clamp(wanted, rate / kMaxRateFactor, rate * kMaxRateFactor);
    }
    const float style = context.style != nullptr ? context.style->speed : 1.0f;
    rate *= state.speed * style;
    return std::isfinite(rate) ? rate : 0.0f;
}

void find_cycle(const MotionContext& context, std::uint32_t index, BlendedCycle& cycle) {
    cycle.weights = state_weights(context, index);
    cycle.rate = cycle_rate(context, index, cycle.weights);
    cycle.segments.assign(context.plan.feet, 0.0f);
    const MotionPlan::State& plan = context.plan.states[index];
    float sum = 0.0f;
    for (std::size_t i = 0; i < plan.cycles.size(); ++i) {
        const std::vector<float>& marks = plan.cycles[i].marks;
        for (std::size_t k = 0; k + 1 < marks.size(); ++k) {
            cycle.segments[k] += cycle.weights[i] * (marks[k + 1] - marks[k]);
            sum += cycle.weights[i] * (marks[k + 1] - marks[k]);
        }
    }
    for (float& segment : cycle.segments) {
        segment = sum > 0.0f ? segment / sum : 1.0f / static_cast<float>(cycle.segments.size());
    }
}

/// Moves `phase` ahead by a part of a cycle, 0 .. 1; returns whether it wrapped.
bool move_ahead(std::span<const float> segments, float part, float& phase) {
    const auto count = static_cast<float>(segments.size());
    bool wrapped = false;
    auto at =
        std::min(static_cast<std::size_t>(std::max(phase * count, 0.0f)), segments.size() - 1);
    float u = std::clamp(phase * count - static_cast<float>(at), 0.0f, 1.0f);
    for (std::size_t i = 0; i <= segments.size() && part > 0.0f; ++i) {
        const float left = (1.0f - u) * segments[at];
        if (part < left) {
            u += part / segments[at];
            break;
        }
        part -= left;
        u = 0.0f;
        wrapped = wrapped || at + 1 == segments.size();
        at = (at + 1) % segments.size();
    }
    phase = std::min((static_cast<float>(at) + u) / count, 1.0f - 1e-7f);
    return wrapped;
}

PhaseStep move_looping(const BlendedCycle& cycle, float seconds, float& phase) {
    const float cycles = cycle.rate * seconds;
    PhaseStep step{.from = phase};
    step.cycles = std::floor(cycles);
    step.cycles += move_ahead(cycle.segments, cycles - step.cycles, phase) ? 1.0f : 0.0f;
    step.to = phase;
    return step;
}

PhaseStep move_once(const BlendedCycle& cycle, float seconds, float& phase) {
    PhaseStep step{.from = phase};
    const float wanted = phase + cycle.rate * seconds;
    step.ended = seconds > 0.0f && cycle.rate > 0.0f && wanted >= 1.0f && phase < 1.0f;
    step.leftover = step.ended ? std::max((wanted - 1.0f) / cycle.rate, 0.0f) : 0.0f;
    phase = std::clamp(wanted, 0.0f, 1.0f);
    step.to = phase;
    return step;
}

/// q' = mean exp(g log(mean^-1 q)) for the joints with a gain other than 1.
void apply_gains(const MotionContext& context, const std::vector<Quat>& means, LocalPose& pose) {
    if (context.style == nullptr || context.style->gains.empty()) {
        return;
    }
    thread_local std::vector<float> gains;
    thread_local std::vector<std::uint8_t> inside;
    const SkeletonData& skeleton = context.skeleton;
    gains.assign(skeleton.joints.size(), 1.0f);
    for (const MotionGain& gain : context.style->gains) {
        inside.assign(skeleton.joints.size(), 0);
        for (std::size_t j = 0; j < gains.size(); ++j) {
            const std::int32_t parent = skeleton.parents[j];
            if ((parent >= 0 && inside[static_cast<std::size_t>(parent)] != 0)
                || skeleton.joints[j] == gain.joint) {
                inside[j] = 1;
                gains[j] = gain.gain;
            }
        }
    }
    for (std::size_t j = 0; j < gains.size(); ++j) {
        if (gains[j] == 1.0f) {
            continue;
        }
        const Quat turn =
            to_same_hemisphere(Quat(1, 0, 0, 0), glm::conjugate(means[j]) * pose.rotations[j]);
        pose.rotations[j] =
            normalize_or_identity(means[j] * exp_rotation(gains[j] * log_rotation(turn)));
    }
}

void set_rest(const MotionContext& context, MotionPose& pose) {
    pose.weights.assign(context.plan.morphs, 0.0f);
    sample_pose(context.skeleton, nullptr, 0.0f, pose.joints, pose.weights);
}

/// One clip of a state at an unwrapped position.
void sample_state_clip(
    const MotionContext& context, std::uint32_t state, std::size_t i, float phase,
    MotionPose& pose) {
    const MotionPlan::State& plan = context.plan.states[state];
    set_rest(context, pose);
    if (plan.fits[i] == 0) {
        return;
    }
    const GraphState& data = context.graph.states[state];
    const float position = cycle_position(plan.cycles[i], phase, data.loop);
    const ClipData& clip = context.assets.clips[data.clips[i].clip.index];
    sample_clip(clip, time_at(plan.cycles[i], position, data.loop), pose.joints, pose.weights);
    if (context.parameters.root == RootMotion::FromClip) {
        remove_root_motion(context.skeleton, pose.joints);
    }
    apply_gains(context, plan.means[i], pose.joints);
}

void apply_offsets(const MotionGraphState& state, float duration, float time, MotionPose& pose) {
    for (std::size_t j = 0; j < std::min(state.turns.size(), pose.joints.size()); ++j) {
        pose.joints.rotations[j] =
            apply_turn(state.turns[j], pose.joints.rotations[j], duration, time);
    }
    for (std::size_t i = 0; i < std::min(state.shifted.size(), state.shifts.size()); ++i) {
        if (state.shifted[i] < pose.joints.size()) {
            Vec3& translation = pose.joints.translations[state.shifted[i]];
            translation = apply_shift(state.shifts[i], translation, duration, time);
        }
    }
    for (std::size_t i = 0; i < std::min(state.morphs.size(), pose.weights.size()); ++i) {
        pose.weights[i] += inertial_vector(state.morphs[i], duration, time).x;
    }
}

/// The pose that an interrupted transition displayed; false if it does not fit the skeleton.
bool copy_frozen(const MotionContext& context, const MotionGraphState& state, MotionPose& pose) {
    const std::size_t joints = context.skeleton.joints.size();
    if (state.frozen_rotations.size() != joints || state.frozen_translations.size() != joints
        || state.frozen_scales.size() != joints) {
        return false;
    }
    pose.joints.rotations = state.frozen_rotations;
    pose.joints.translations = state.frozen_translations;
    pose.joints.scales = state.frozen_scales;
    pose.weights = state.frozen_weights;
    pose.weights.resize(context.plan.morphs, 0.0f);
    return true;
}

void override_joints(
    const MotionPlan::Layer& plan, const MotionPose& layer, float weight, MotionPose& pose) {
    for (const std::uint16_t j : plan.joints) {
        LocalPose& to = pose.joints;
        to.rotations[j] = slerp(to.rotations[j], layer.joints.rotations[j], weight);
        to.translations[j] = glm::mix(to.translations[j], layer.joints.translations[j], weight);
        to.scales[j] = glm::mix(to.scales[j], layer.joints.scales[j], weight);
    }
    for (std::size_t i = 0; plan.is_whole && i < plan.weights.size(); ++i) {
        pose.weights[i] = glm::mix(pose.weights[i], layer.weights[i], weight);
    }
}

void add_joints(
    const MotionPlan::Layer& plan, const MotionPose& layer, float weight, MotionPose& pose) {
    for (const std::uint16_t j : plan.joints) {
        LocalPose& to = pose.joints;
        const Quat turn = to_same_hemisphere(
            Quat(1, 0, 0, 0),
            glm::conjugate(plan.reference.rotations[j]) * layer.joints.rotations[j]);
        to.rotations[j] =
            normalize_or_identity(to.rotations[j] * exp_rotation(weight * log_rotation(turn)));
        to.translations[j] +=
            weight * (layer.joints.translations[j] - plan.reference.translations[j]);
        to.scales[j] += weight * (layer.joints.scales[j] - plan.reference.scales[j]);
    }
    for (std::size_t i = 0; plan.is_whole && i < plan.weights.size(); ++i) {
        pose.weights[i] += weight * (layer.weights[i] - plan.weights[i]);
    }
}

void apply_layers(const MotionContext& context, const MotionGraphState& state, MotionPose& pose) {
    thread_local MotionPose sampled;
    for (std::size_t i = 0; i < context.graph.layers.size(); ++i) {
        const GraphLayer& layer = context.graph.layers[i];
        const MotionPlan::Layer& plan = context.plan.layers[i];
        const LayerPlayback playback =
            i < state.layers.size() ? state.layers[i]
                                    : LayerPlayback{.fade = layer.event.empty() ? 1.0f : 0.0f};
        const float scale = layer.parameter != GraphParameter::None
                                ? parameter_of(context.parameters, layer.parameter)
                                : 1.0f;
        const float faded = playback.fade * playback.fade * (3.0f - 2.0f * playback.fade);
        const float weight = faded * layer.weight * scale;
        if (!plan.fits || weight == 0.0f || !std::isfinite(weight)) {
            continue;
        }
        set_rest(context, sampled);
        sample_clip(
            context.assets.clips[layer.clip.index], playback.time, sampled.joints, sampled.weights);
        if (layer.mode == LayerMode::Additive) {
            add_joints(plan, sampled, weight, pose);
        } else {
            override_joints(plan, sampled, std::clamp(weight, 0.0f, 1.0f), pose);
        }
    }
}

}  // namespace

ClipWeights state_weights(const MotionContext& context, std::uint32_t state) {
    return blend_weights(context.graph.states[state], context.parameters);
}

PhaseStep advance_playback(const MotionContext& context, GraphPlayback& playback, float seconds) {
    if (!is_state(context, playback.state)) {
        return {playback.phase, playback.phase};
    }
    thread_local BlendedCycle cycle;
    find_cycle(context, playback.state, cycle);
    return context.graph.states[playback.state].loop ? move_looping(cycle, seconds, playback.phase)
                                                     : move_once(cycle, seconds, playback.phase);
}

PhaseStep advance_together(
    const MotionContext& context, GraphPlayback& from, GraphPlayback& to, float share,
    float seconds) {
    thread_local BlendedCycle first;
    thread_local BlendedCycle second;
    find_cycle(context, from.state, first);
    find_cycle(context, to.state, second);
    second.rate = glm::mix(first.rate, second.rate, share);
    for (std::size_t k = 0; k < second.segments.size(); ++k) {
        second.segments[k] = glm::mix(first.segments[k], second.segments[k], share);
    }
    const PhaseStep step = move_looping(second, seconds, to.phase);
    from.phase = to.phase;
    return step;
}

void blend_pose(const MotionPose& other, float share, MotionPose& pose) {
    LocalPose& to = pose.joints;
    if (share <= 0.0f) {
        return;
    }
    if (share >= 1.0f) {
        pose = other;
        return;
    }
    slerp_rotations(to.rotations, other.joints.rotations, share, to.rotations);
    for (std::size_t j = 0; j < to.size(); ++j) {
        to.translations[j] = glm::mix(to.translations[j], other.joints.translations[j], share);
        to.scales[j] = glm::mix(to.scales[j], other.joints.scales[j], share);
    }
    for (std::size_t i = 0; i < pose.weights.size(); ++i) {
        pose.weights[i] = glm::mix(pose.weights[i], other.weights[i], share);
    }
}

void evaluate_state(const MotionContext& context, const GraphPlayback& playback, MotionPose& pose) {
    if (!is_state(context, playback.state) || context.graph.states[playback.state].clips.empty()) {
        set_rest(context, pose);
        return;
    }
    thread_local MotionPose next;
    const ClipWeights weights = state_weights(context, playback.state);
    float sum = 0.0f;
    for (std::size_t i = 0; i < context.plan.states[playback.state].cycles.size(); ++i) {
        if (!(i < kMaxGraphClips && weights[i] > 0.0f)) {
            continue;
        }
        MotionPose& sampled = sum == 0.0f ? pose : next;
        sample_state_clip(context, playback.state, i, playback.phase, sampled);
        if (sum > 0.0f) {
            blend_pose(next, weights[i] / (sum + weights[i]), pose);
        }
        sum += weights[i];
    }
}

void evaluate_state_earlier(
    const MotionContext& context, const GraphPlayback& playback, float seconds, MotionPose& pose) {
    const bool loops =
        !is_state(context, playback.state) || context.graph.states[playback.state].loop;
    GraphPlayback moved = playback;
    if (loops || playback.phase < 1.0f) {  // else it holds its last pose
        advance_playback(context, moved, -seconds);
    }
    if (loops || moved.phase > 0.0f) {
        evaluate_state(context, moved, pose);
        return;
    }
    // Before its beginning, as if it had come from there in the same way.
    thread_local MotionPose now;
    thread_local MotionPose later;
    evaluate_state(context, playback, now);
    moved = playback;
    advance_playback(context, moved, seconds);
    evaluate_state(context, moved, later);
    pose = now;
    for (std::size_t j = 0; j < now.joints.size(); ++j) {
        const Quat& q = now.joints.rotations[j];
        pose.joints.rotations[j] = q * glm::conjugate(later.joints.rotations[j]) * q;
        pose.joints.translations[j] =
            2.0f * now.joints.translations[j] - later.joints.translations[j];
    }
    for (std::size_t i = 0; i < now.weights.size(); ++i) {
        pose.weights[i] = 2.0f * now.weights[i] - later.weights[i];
    }
}

float crossfade_share(const GraphTransition& transition, float clock) {
    const float s =
        transition.duration > 0.0f ? std::clamp(clock / transition.duration, 0.0f, 1.0f) : 1.0f;
    return transition.smooth ? s * s * (3.0f - 2.0f * s) : s;
}

void evaluate_states(
    const MotionContext& context, const MotionGraphState& state, float earlier, MotionPose& pose) {
    const auto evaluate = [&](const GraphPlayback& playback, MotionPose& to) {
        earlier > 0.0f ? evaluate_state_earlier(context, playback, earlier, to)
                       : evaluate_state(context, playback, to);
    };
    evaluate(state.current, pose);
    if (state.transition >= context.graph.transitions.size()) {
        return;
    }
    const GraphTransition& transition = context.graph.transitions[state.transition];
    const float clock = state.clock - earlier;
    if (state.source.state == kNoGraphState) {
        apply_offsets(state, transition.duration, clock, pose);
        return;
    }
    thread_local MotionPose source;
    if (state.source.state == kFrozenPose) {
        if (!copy_frozen(context, state, source)) {
            return;
        }
    } else {
        evaluate(state.source, source);
    }
    blend_pose(source, 1.0f - crossfade_share(transition, clock), pose);
}

void evaluate_motion(
    const MotionContext& context, const MotionGraphState& state, MotionPose& pose) {
    evaluate_states(context, state, 0.0f, pose);
    apply_layers(context, state, pose);
}

}  // namespace limn
