#include "systems/animation/graph/graph_edit_system.h"

#include "systems/animation/graph/graph_transition.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

// Techniques: char.motion-select

namespace limn {

namespace {

constexpr float kEditBlend = 0.25f;  ///< in which a character takes an edit over [s]

/// The same state in the edited graph; kNoGraphState if it was removed.
std::uint32_t
find_again(const MotionGraphData& before, const MotionGraphData& now, std::uint32_t state) {
    return state < before.states.size() ? find_graph_state(now, before.states[state].name)
                                        : kNoGraphState;
}

/// Whether a playback, which is nothing, a frozen pose or a state, shows the same in the edited
/// graph; sets its index there.
bool keep_playback(
    const MotionGraphData& before, const MotionGraphData& now, GraphPlayback& playback) {
    if (playback.state == kNoGraphState || playback.state == kFrozenPose) {
        return true;
    }
    const std::uint32_t found = find_again(before, now, playback.state);
    const bool same = found != kNoGraphState && now.states[found] == before.states[playback.state];
    playback.state = same ? found : playback.state;
    return same;
}

/// Likewise the transition that is not over.
bool keep_transition(
    const MotionGraphData& before, const MotionGraphData& now, std::uint32_t& transition) {
    if (transition >= before.transitions.size()) {
        transition = kNoGraphState;
        return true;
    }
    const auto found =
        std::find(now.transitions.begin(), now.transitions.end(), before.transitions[transition]);
    if (found == now.transitions.end()) {
        return false;
    }
    transition = static_cast<std::uint32_t>(found - now.transitions.begin());
    return true;
}

/// Index of the layer in the graph before the edit, or past its end.
std::size_t layer_before(const MotionGraphData& before, const GraphLayer& layer, std::size_t at) {
    const auto is_same = [&](const GraphLayer& other) {
        return other.name == layer.name && (!layer.name.empty() || other.clip == layer.clip);
    };
    if (at < before.layers.size() && is_same(before.layers[at])) {
        return at;
    }
    const auto found = std::find_if(before.layers.begin(), before.layers.end(), is_same);
    return static_cast<std::size_t>(found - before.layers.begin());
}

void keep_layers(
    const MotionGraphData& before, const MotionGraphData& now, MotionGraphState& state) {
    if (state.layers.size() < before.layers.size()) {
        return;  // it has not played yet
    }
    std::vector<LayerPlayback> layers;
    for (std::size_t i = 0; i < now.layers.size(); ++i) {
        const std::size_t old = layer_before(before, now.layers[i], i);
        const LayerPlayback added = {0.0f, 0.0f, now.layers[i].event.empty() ? 1u : 0u};
        layers.push_back(old < before.layers.size() ? state.layers[old] : added);
    }
    state.layers = std::move(layers);
}

/// Plans of the edited graph for the skeletons that play it.
std::vector<MotionPlans::Entry> make_plans_again(
    MotionGraphId graph, const MotionGraphData& now, const MotionPlans& plans,
    const Assets& assets) {
    std::vector<MotionPlans::Entry> made;
    for (const MotionPlans::Entry& entry : plans.entries) {
        if (entry.graph == graph) {
            const SkeletonData& skeleton = assets.skeletons[entry.skeleton.index];
            made.push_back(
                {graph, entry.skeleton,
                 std::make_shared<const MotionPlan>(make_motion_plan(now, skeleton, assets))});
        }
    }
    return made;
}

bool has_edit(const MotionGraphs& data, MotionGraphId graph) {
    return std::any_of(data.edits.begin(), data.edits.end(), [graph](const MotionGraphEdit& edit) {
        return edit.graph == graph;
    });
}

/// The transition by which characters come to an edited graph. Nothing triggers it: it has neither
/// an event nor a parameter.
GraphTransition make_blend(const MotionGraphData& graph) {
    return {.to = graph.states[0].name, .duration = kEditBlend};
}

bool has_blend(const MotionGraphData& graph) {
    return !graph.transitions.empty() && graph.transitions.back() == make_blend(graph);
}

}  // namespace

void adopt_graph(
    const MotionContext& before, const MotionContext& now, std::uint32_t blend,
    MotionGraphState& state) {
    keep_layers(before.graph, now.graph, state);
    GraphPlayback current = state.current;
    GraphPlayback source = state.source;
    std::uint32_t transition = state.transition;
    if (before.graph.feet == now.graph.feet && keep_playback(before.graph, now.graph, current)
        && keep_transition(before.graph, now.graph, transition)
        && keep_playback(before.graph, now.graph, source)) {
        state.current = current;
        state.source = source;
        state.transition = transition;
        return;
    }
    const std::uint32_t found = find_again(before.graph, now.graph, state.current.state);
    GraphPlayback next = {0, now.parameters.phase};
    if (found != kNoGraphState) {
        const bool starts_over = now.graph.states[found].loop && state.current.phase >= 1.0f;
        next = {found, starts_over ? 0.0f : state.current.phase};
    }
    capture_offsets(before, now, next, state);
    state.current = next;
    state.transition = blend;
}

void apply_graph_edits(
    Query<
        const Skeleton, const MotionGraph, MotionGraphState, Optional<const MotionStyle>,
        const Transform>
        characters,
    Res<MotionGraphs> data, Res<const Assets> assets, Res<MotionPlans> plans) {
    characters.each([&](const Skeleton&, const MotionGraph& graph, const MotionGraphState& state,
                        const MotionStyle*, const Transform&) {
        // Who changes to another graph is taken over by an edit that leaves it as it is.
        if (state.graph != graph.graph && graph.graph.index < data->graphs.size()
            && !has_edit(*data, graph.graph)) {
            data->edits.push_back({graph.graph, data->graphs[graph.graph.index]});
        }
    });
    for (MotionGraphEdit& edit : data->edits) {
        if (edit.graph.index >= data->graphs.size() || edit.data.states.empty()) {
            continue;
        }
        MotionGraphData& now = edit.data;
        bool is_used = has_blend(now);
        if (!is_used) {
            now.transitions.push_back(make_blend(now));
        }
        const auto blend = static_cast<std::uint32_t>(now.transitions.size() - 1);
        MotionPlans planned{make_plans_again(edit.graph, now, *plans, *assets)};
        characters.each([&](const Skeleton& skeleton, const MotionGraph& graph,
                            MotionGraphState& state, const MotionStyle* style,
                            const Transform& transform) {
            if (graph.graph != edit.graph && state.graph != edit.graph) {
                return;
            }
            const MotionPlan* const old_plan = plans->find(state.graph, skeleton.skeleton);
            if (old_plan == nullptr) {  // it has not played yet
                state.graph = graph.graph;
                return;
            }
            const SkeletonData& bones = assets->skeletons[skeleton.skeleton.index];
            if (planned.find(edit.graph, skeleton.skeleton) == nullptr) {
                planned.entries.push_back(
                    {edit.graph, skeleton.skeleton,
                     std::make_shared<const MotionPlan>(make_motion_plan(now, bones, *assets))});
            }
            const MotionGraphData& before = data->graphs[state.graph.index];
            const MotionPlan& plan = *planned.find(edit.graph, skeleton.skeleton);
            const float scale = transform.scale.z;
            adopt_graph(
                {*assets, bones, before, *old_plan, graph, style, scale},
                {*assets, bones, now, plan, graph, style, scale}, blend, state);
            state.graph = edit.graph;
            is_used = is_used || state.transition == blend;
        });
        if (!is_used) {
            now.transitions.pop_back();
        }
        std::erase_if(plans->entries, [&](const MotionPlans::Entry& entry) {
            return entry.graph == edit.graph;
        });
        plans->entries.insert(plans->entries.end(), planned.entries.begin(), planned.entries.end());
        data->graphs[edit.graph.index] = std::move(now);
    }
    data->edits.clear();
}

}  // namespace limn
