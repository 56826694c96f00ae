#include "content/app/panels/graph_controls.h"

#include "ecs/components/motion_graph.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "systems/animation/graph/blend_space.h"
#include "systems/animation/graph/motion_graph_system.h"

#include <algorithm>

namespace limn {
namespace {

void add_event(const std::string& event, std::vector<std::string>& events) {
    if (!event.empty() && event != kEndEvent
        && std::find(events.begin(), events.end(), event) == events.end()) {
        events.push_back(event);
    }
}

std::vector<std::string> events_of(const MotionGraphData& graph) {
    std::vector<std::string> events;
    for (const GraphTransition& transition : graph.transitions) {
        add_event(transition.event, events);
    }
    for (const GraphLayer& layer : graph.layers) {
        add_event(layer.event, events);
        add_event(layer.until, events);
    }
    return events;
}

}  // namespace

GraphView view_graph(const World& world, Entity character) {
    GraphView view;
    const auto* const graph = world.find<MotionGraph>(character);
    const auto* const state = world.find<MotionGraphState>(character);
    const auto* const graphs = world.find_resource<MotionGraphs>();
    if (graph == nullptr || state == nullptr || graphs == nullptr
        || graph->graph.index >= graphs->graphs.size()) {
        return view;
    }
    const MotionGraphData& data = graphs->graphs[graph->graph.index];
    view.events = events_of(data);
    if (state->current.state >= data.states.size()) {
        return view;
    }
    const GraphState& current = data.states[state->current.state];
    view.state = current.name;
    view.phase = state->current.phase;
    if (state->transition < data.transitions.size()) {
        const GraphTransition& transition = data.transitions[state->transition];
        const std::string& from = transition.from;
        view.state = (from.empty() ? "any" : from) + " -> " + current.name;
        view.clock = state->clock;
        view.duration = transition.duration;
    }
    const ClipWeights weights = blend_weights(current, *graph);
    const auto* const assets = world.find_resource<Assets>();
    for (std::size_t i = 0; i < std::min(current.clips.size(), kMaxGraphClips); ++i) {
        const std::uint32_t clip = current.clips[i].clip.index;
        const bool exists = assets != nullptr && clip < assets->clips.size();
        view.clips.emplace_back(exists ? assets->clips[clip].name : "none", weights[i]);
    }
    for (std::size_t i = 0; i < std::min(data.layers.size(), state->layers.size()); ++i) {
        view.layers.emplace_back(data.layers[i].name, state->layers[i].fade);
    }
    return view;
}

void send_graph_event(World& world, Entity character, const std::string& event) {
    if (auto* const graph = world.find<MotionGraph>(character)) {
        graph->events.push_back(event);
    }
}

}  // namespace limn
