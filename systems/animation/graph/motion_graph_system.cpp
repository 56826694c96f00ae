#include "systems/animation/graph/motion_graph_system.h"

#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/graph/graph_transition.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.blend, char.motion-select

namespace limn {

namespace {

constexpr int kMaxEnds = 4;                 ///< of clips, in one step
constexpr float kLastPhase = 1.0f - 1e-6f;  ///< still moving: the pose is not held yet
constexpr float kTurnTime = 0.25f;          ///< in which a heading is corrected [s]
constexpr float kTurnResponse = 0.1f;       ///< of the rate of the turn [s]
constexpr float kTurnSpeed = 0.3f;          ///< share of the speed that is left in a turn

template <typename T>
const T* asset_at(const std::vector<T>& assets, std::uint32_t index) {
    return index < assets.size() ? &assets[index] : nullptr;
}

bool is_fulfilled(const MotionContext& context, const GraphTransition& transition) {
    if (transition.parameter == GraphParameter::None) {
        return true;
    }
    const float value = parameter_of(context.parameters, transition.parameter);
    return value > transition.above && value < transition.below;
}

bool is_looping(const MotionContext& context, std::uint32_t state) {
    return state < context.graph.states.size() && context.graph.states[state].loop;
}

float start_phase(
    const MotionContext& context, const GraphTransition& transition, const GraphPlayback& old,
    std::uint32_t target) {
    const MotionPlan::State& plan = context.plan.states[target];
    const bool loop = context.graph.states[target].loop;
    if (transition.start == StartPhase::Same && loop && is_looping(context, old.state)) {
        return old.phase;
    }
    if (plan.cycles.empty()) {
        return 0.0f;
    }
    const ClipCycle& cycle = plan.cycles[heaviest(state_weights(context, target))];
    const float time = transition.start == StartPhase::Time ? transition.time : 0.0f;
    return phase_at(cycle, cycle.duration > 0.0f ? time / cycle.duration : 0.0f, loop);
}

/// Makes the current state, or the pose of a transition that is not over, the source of a
/// crossfade.
void capture_source(const MotionContext& context, MotionGraphState& state) {
    if (state.transition == kNoGraphState) {
        state.source = state.current;
        return;
    }
    thread_local MotionPose shown;
    evaluate_states(context, state, 0.0f, shown);
    end_transition(state);
    state.source.state = kFrozenPose;
    state.frozen_translations = shown.joints.translations;
    state.frozen_rotations = shown.joints.rotations;
    state.frozen_scales = shown.joints.scales;
    state.frozen_weights = shown.weights;
}

/// Returns whether it began: the current state does not unless it restarts.
bool begin_transition(const MotionContext& context, std::uint32_t index, MotionGraphState& state) {
    const GraphTransition& transition = context.graph.transitions[index];
    const std::uint32_t target = find_graph_state(context.graph, transition.to);
    if (target == kNoGraphState || (target == state.current.state && !transition.restart)) {
        return false;
    }
    const GraphPlayback next = {target, start_phase(context, transition, state.current, target)};
    const bool is_cut = !(transition.duration > 0.0f);
    if (is_cut) {
        end_transition(state);
    } else if (transition.blend == TransitionBlend::Inertialize) {
        capture_offsets(context, context, next, state);
    } else {
        capture_source(context, state);
    }
    state.current = next;
    state.transition = is_cut ? kNoGraphState : index;
    state.clock = 0.0f;
    state.cut = is_cut ? 1 : state.cut;
    return true;
}

/// A clip that does not loop is at its end.
bool has_ended(const MotionContext& context, const GraphPlayback& playback) {
    return !is_looping(context, playback.state) && playback.phase >= 1.0f;
}

bool is_locked(const MotionContext& context, const MotionGraphState& state) {
    const GraphTransition* const transition = asset_at(context.graph.transitions, state.transition);
    return transition != nullptr && !transition->interruptible;
}

/// Returns whether a transition began.
bool take_event(const MotionContext& context, std::string_view event, MotionGraphState& state) {
    const std::uint32_t found = find_transition(context, state.current.state, event);
    return found != kNoGraphState && begin_transition(context, found, state);
}

void start_layers(const MotionContext& context, std::string_view event, MotionGraphState& state) {
    for (std::size_t i = 0; i < context.graph.layers.size(); ++i) {
        const GraphLayer& layer = context.graph.layers[i];
        if (!layer.event.empty() && layer.event == event) {
            state.layers[i].time = state.layers[i].fade > 0.0f ? state.layers[i].time : 0.0f;
            state.layers[i].playing = 1;
        } else if (!layer.until.empty() && layer.until == event) {
            state.layers[i].playing = 0;
        }
    }
}

void take_events(
    const MotionContext& context, std::vector<std::string>& events, MotionGraphState& state) {
    std::size_t taken = 0;
    while (taken < events.size() && !is_locked(context, state)) {
        start_layers(context, events[taken], state);
        take_event(context, events[taken], state);
        ++taken;
    }
    events.erase(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(taken));
    if (!is_locked(context, state)) {
        take_event(context, "", state);
    }
}

/// Events of the clip with the largest weight that `step` plays.
void fire_clip_events(
    const MotionContext& context, const PhaseStep& step, MotionGraphState& state) {
    const std::uint32_t index = state.current.state;
    if (index >= context.graph.states.size() || context.graph.states[index].clips.empty()) {
        return;
    }
    const std::size_t i = heaviest(state_weights(context, index));
    const GraphState& data = context.graph.states[index];
    const ClipData* const clip = asset_at(context.assets.clips, data.clips[i].clip.index);
    const ClipCycle& cycle = context.plan.states[index].cycles[i];
    if (clip == nullptr || !(cycle.duration > 0.0f)) {
        return;
    }
    const float from = cycle_position(cycle, step.from, data.loop);
    const float to = cycle_position(cycle, step.to, data.loop) + step.cycles;
    for (const ClipEvent& event : clip->events) {
        const float at = event.time / cycle.duration;
        const float first = data.loop ? std::floor(from - at) + 1.0f + at : at;
        if (first > from && first <= to) {
            state.fired.push_back(event.name);
        }
    }
}

void advance_layers(const MotionContext& context, float seconds, MotionGraphState& state) {
    for (std::size_t i = 0; i < context.graph.layers.size(); ++i) {
        const GraphLayer& layer = context.graph.layers[i];
        LayerPlayback& playback = state.layers[i];
        const ClipData* const clip = asset_at(context.assets.clips, layer.clip.index);
        const float duration = clip != nullptr ? clip->duration : 0.0f;
        const float time = playback.time + layer.speed * seconds;
        const bool ends = !layer.loop && layer.until.empty() && !layer.event.empty();
        if (ends && time >= duration - layer.fade) {
            playback.playing = 0;
        }
        playback.time = clip_time(duration, time, layer.loop);
        const float change = layer.fade > 0.0f ? seconds / layer.fade : 1.0f;
        playback.fade =
            std::clamp(playback.fade + (playback.playing != 0 ? change : -change), 0.0f, 1.0f);
    }
}

void prepare_layers(const MotionContext& context, MotionGraphState& state) {
    for (std::size_t i = state.layers.size(); i < context.graph.layers.size(); ++i) {
        const bool plays = context.graph.layers[i].event.empty();
        state.layers.push_back({0.0f, plays ? 1.0f : 0.0f, plays ? 1u : 0u});
    }
}

GroundMove mix_moves(const GroundMove& a, const GroundMove& b, float share) {
    return {glm::mix(a.way, b.way, share), glm::mix(a.yaw, b.yaw, share)};
}

/// Advances the states that play; returns what the current one plays, and the move.
PhaseStep advance_states(
    const MotionContext& context, float seconds, MotionGraphState& state, GroundMove& move) {
    const bool moves = context.parameters.root == RootMotion::FromClip;
    const GraphTransition* const transition = asset_at(context.graph.transitions, state.transition);
    if (transition == nullptr || state.source.state >= context.graph.states.size()) {
        const PhaseStep step = advance_playback(context, state.current, seconds);
        move = moves ? root_move(context, state.current.state, step) : GroundMove{};
        return step;
    }
    const float share = crossfade_share(*transition, state.clock);
    const bool together = transition->start == StartPhase::Same
                          && is_looping(context, state.source.state)
                          && is_looping(context, state.current.state);
    PhaseStep source;
    PhaseStep step;
    if (together) {
        step = advance_together(context, state.source, state.current, share, seconds);
        source = step;
    } else {
        source = advance_playback(context, state.source, seconds);
        step = advance_playback(context, state.current, seconds);
    }
    if (moves) {
        move = mix_moves(
            root_move(context, state.source.state, source),
            root_move(context, state.current.state, step), share);
    }
    return step;
}

/// Angle from the heading to `direction`, about y [rad].
float angle_to(const Quat& rotation, const Vec3& direction) {
    const Vec3 local = glm::conjugate(rotation) * Vec3(direction.x, 0, direction.z);
    return std::atan2(local.x, local.z);
}

void move_entity(
    const MotionGraph& graph, const MotionStyle* style, const GroundMove& move, float seconds,
    float speed_before, Transform& transform) {
    GroundMove way = move;
    if (graph.root == RootMotion::FromSpeed) {
        const float factor = style != nullptr ? style->speed : 1.0f;
        const float ahead = 0.5f * (speed_before + graph.speed) * seconds * factor;
        const float yaw = graph.turn * seconds;
        // Along an arc: the chord is at half the turn.
        const float half = 0.5f * yaw;
        const float chord = std::abs(half) > 1e-4f ? ahead * std::sin(half) / half : ahead;
        way = {Vec2(std::sin(half), std::cos(half)) * chord, yaw};
    }
    if (way.way != Vec2(0)) {
        transform.position += transform.rotation * Vec3(way.way.x, 0, way.way.y);
    }
    if (way.yaw != 0.0f) {
        transform.rotation =
            normalize_or_identity(transform.rotation * rotation_about({0, 1, 0}, way.yaw));
    }
}

}  // namespace

void add_motion_states(
    Query<const MotionGraph, With<Skeleton>, Without<MotionGraphState>> graphs,
    Res<const MotionGraphs> data, Commands commands) {
    graphs.each([&](Entity entity, const MotionGraph& graph) {
        if (graph.graph.index < data->graphs.size()) {
            MotionGraphState state;
            state.graph = graph.graph;
            state.current = {0, graph.phase};
            commands.add(entity, std::move(state));
        }
    });
}

void prepare_motion_plans(
    Query<const MotionGraph, const Skeleton> graphs, Res<const MotionGraphs> data,
    Res<const Assets> assets, Res<MotionPlans> plans) {
    graphs.each([&](const MotionGraph& graph, const Skeleton& skeleton) {
        const MotionGraphData* const found = asset_at(data->graphs, graph.graph.index);
        const SkeletonData* const bones = asset_at(assets->skeletons, skeleton.skeleton.index);
        if (found != nullptr && bones != nullptr
            && plans->find(graph.graph, skeleton.skeleton) == nullptr) {
            plans->entries.push_back(
                {graph.graph, skeleton.skeleton,
                 std::make_shared<const MotionPlan>(make_motion_plan(*found, *bones, *assets))});
        }
    });
}

std::uint32_t
find_transition(const MotionContext& context, std::uint32_t state, std::string_view event) {
    const std::vector<GraphTransition>& transitions = context.graph.transitions;
    const GraphState* const current = asset_at(context.graph.states, state);
    for (const bool from_any : {false, true}) {
        for (std::uint32_t i = 0; i < transitions.size(); ++i) {
            const GraphTransition& transition = transitions[i];
            const bool leaves = from_any ? transition.from.empty()
                                         : current != nullptr && !transition.from.empty()
                                               && transition.from == current->name;
            const bool is_idle = event.empty() && transition.parameter == GraphParameter::None;
            if (leaves && !is_idle && transition.event == event
                && is_fulfilled(context, transition)) {
                return i;
            }
        }
    }
    return kNoGraphState;
}

GroundMove step_motion_graph(
    const MotionContext& context, std::vector<std::string>& events, float seconds,
    MotionGraphState& state) {
    GroundMove sum;
    state.fired.clear();
    state.cut = 0;
    prepare_layers(context, state);
    if (state.current.state >= context.graph.states.size()) {
        state.current = {};
        end_transition(state);
        events.clear();
        return sum;
    }
    take_events(context, events, state);
    float left = seconds;
    for (int i = 0; i < kMaxEnds; ++i) {
        GroundMove move;
        const PhaseStep step = advance_states(context, left, state, move);
        sum = compose(sum, move);
        state.clock += state.transition != kNoGraphState ? left - step.leftover : 0.0f;
        fire_clip_events(context, step, state);
        if (!has_ended(context, state.current) || is_locked(context, state)) {
            break;
        }
        if (step.ended) {
            state.current.phase = kLastPhase;
        }
        if (!take_event(context, kEndEvent, state)) {
            state.current.phase = 1.0f;
            break;
        }
        left = step.leftover;
    }
    const GraphTransition* const transition = asset_at(context.graph.transitions, state.transition);
    if (transition != nullptr && state.clock >= transition->duration) {
        end_transition(state);
    }
    advance_layers(context, seconds, state);
    return sum;
}

void follow_intent(
    const MoveIntent& intent, const Quat& rotation, float seconds, MotionGraph& graph) {
    const float speed = glm::length(Vec2(intent.velocity.x, intent.velocity.z));
    const bool faces = Vec2(intent.facing.x, intent.facing.z) != Vec2(0);
    const Vec3 direction = faces ? intent.facing : intent.velocity;
    if (!std::isfinite(speed) || !(seconds > 0.0f)) {
        return;
    }
    const bool turns = faces || speed > 1e-3f;
    const float error = turns ? angle_to(rotation, direction) : 0.0f;
    const float wanted_turn =
        std::clamp(error / std::max(seconds, kTurnTime), -graph.turn_rate, graph.turn_rate);
    graph.turn += (wanted_turn - graph.turn) * (1.0f - std::exp(-seconds / kTurnResponse));
    const float ahead =
        speed > 1e-3f ? std::max(std::cos(angle_to(rotation, intent.velocity)), kTurnSpeed) : 0.0f;
    const float change = graph.acceleration * seconds;
    graph.speed += std::clamp(speed * ahead - graph.speed, -change, change);
}

void update_motion_graphs(
    Query<
        const Skeleton, MotionGraph, MotionGraphState, Optional<const MotionStyle>,
        Optional<const MoveIntent>, Transform>
        characters,
    Res<const MotionGraphs> data, Res<const Assets> assets, Res<const MotionPlans> plans,
    Res<const FrameTime> time) {
    const float seconds = time->step;
    characters.par_each([&](const Skeleton& skeleton, MotionGraph& graph, MotionGraphState& state,
                            const MotionStyle* style, const MoveIntent* intent,
                            Transform& transform) {
        const MotionPlan* const plan = plans->find(graph.graph, skeleton.skeleton);
        if (plan == nullptr) {
            return;
        }
        const float speed_before = graph.speed;
        if (intent != nullptr) {
            follow_intent(*intent, transform.rotation, seconds, graph);
        }
        const MotionContext context = {
            *assets,
            assets->skeletons[skeleton.skeleton.index],
            data->graphs[graph.graph.index],
            *plan,
            graph,
            style,
            transform.scale.z};
        const GroundMove move = step_motion_graph(context, graph.events, seconds, state);
        move_entity(graph, style, move, seconds, speed_before, transform);
    });
}

}  // namespace limn
