#include "content/load/level/motion_graph_json.h"

#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

// Techniques: char.motion-select

namespace limn {

namespace {

std::vector<std::string_view> state_names(const MotionGraphData& graph) {
    std::vector<std::string_view> names;
    for (const GraphState& state : graph.states) {
        names.emplace_back(state.name);
    }
    return names;
}

Status check_clips(const GraphState& state, const JsonValue& json, const JsonLocation& at) {
    const JsonValue& clips = json["clips"];
    if (state.clips.size() > kMaxGraphClips) {
        return error_at(
            location_in(at, "clips"), clips.at, fmt::format("{} clips", state.clips.size()),
            fmt::format("at most {}", kMaxGraphClips));
    }
    if (state.clips.size() > 1 && state.x == GraphParameter::None) {
        return error_at(
            at, json.at, "several clips and no parameter that blends them",
            R"("x": one of speed turn slope amount)");
    }
    const bool is_plane = state.y != GraphParameter::None;
    for (std::size_t i = 0; i < state.clips.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const Vec2 apart = state.clips[i].at - state.clips[k].at;
            if (apart.x == 0.0f && (apart.y == 0.0f || !is_plane)) {
                return error_at(
                    item_in(location_in(at, "clips"), i), clips.items[i].at,
                    "the same \"at\" as an earlier clip", "another point of the blend space");
            }
        }
    }
    return Done{};
}

Status check_states(const MotionGraphData& graph, const JsonValue& json, const JsonLocation& at) {
    if (graph.states.empty()) {
        return error_at(at, json.at, "no states", R"("states": [{"name": ..., "clips": ...}])");
    }
    for (std::size_t i = 0; i < graph.states.size(); ++i) {
        const JsonLocation here = item_in(location_in(at, "states"), i);
        const JsonValue& state = json["states"].items[i];
        const std::string& name = graph.states[i].name;
        if (name.empty()) {
            return error_at(here, state.at, "a state without a name", "\"name\": a word");
        }
        if (find_graph_state(graph, name) != i) {
            return error_at(
                here, state["name"].at, "a second state " + in_quotes(name), "another name");
        }
        LIMN_TRY(check_clips(graph.states[i], state, here));
    }
    return Done{};
}

Status check_state_name(
    const MotionGraphData& graph, const JsonValue& transition, std::string_view key,
    const std::string& name, const JsonLocation& at) {
    if (find_graph_state(graph, name) != kNoGraphState) {
        return Done{};
    }
    const JsonValue* const found = transition.find(key);
    const std::vector<std::string_view> names = state_names(graph);
    return error_at(
        location_in(at, key), found != nullptr ? found->at : transition.at,
        found != nullptr ? "the state " + in_quotes(name) : "no next state",
        "one of " + join_text(names, ", ") + did_you_mean(name, names));
}

Status
check_transitions(const MotionGraphData& graph, const JsonValue& json, const JsonLocation& at) {
    for (std::size_t i = 0; i < graph.transitions.size(); ++i) {
        const GraphTransition& transition = graph.transitions[i];
        const JsonLocation here = item_in(location_in(at, "transitions"), i);
        const JsonValue& source = json["transitions"].items[i];
        LIMN_TRY(check_state_name(graph, source, "to", transition.to, here));
        if (!transition.from.empty()) {
            LIMN_TRY(check_state_name(graph, source, "from", transition.from, here));
        }
        if (transition.event.empty() && transition.parameter == GraphParameter::None) {
            return error_at(
                here, source.at, "a transition that nothing triggers",
                "an \"event\" or a \"parameter\"");
        }
    }
    return Done{};
}

}  // namespace

Result<MotionGraphData>
read_motion_graph(const JsonValue& json, const JsonLocation& at, const NameResolver& names) {
    MotionGraphData graph;
    LIMN_TRY(expect(json, JsonKind::Object, at, "a motion graph (an object)"));
    LIMN_TRY(read_struct(json, graph, at, names));
    LIMN_TRY(check_states(graph, json, at));
    LIMN_TRY(check_transitions(graph, json, at));
    return graph;
}

}  // namespace limn
