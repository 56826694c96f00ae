#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Motion graphs: which clips a character plays, chosen by events and by how fast it moves. A state
// is a clip or a blend space of clips; transitions lead from one state to another; layers are added
// on top. Graphs are stored in the MotionGraphs resource; characters share them.
// Techniques: char.blend, char.motion-modify, char.motion-select

struct MotionGraphId {
    std::uint32_t index = 0xffffffffu;
    bool operator==(const MotionGraphId&) const = default;
};
template <>
inline constexpr const char* asset_kind<MotionGraphId> = "motion_graph";

/// A field of MotionGraph that blends clips or triggers transitions.
enum class GraphParameter : std::uint8_t { None, Speed, Turn, Slope, Amount };

/// A clip of a state, at a point of its blend space.
struct GraphClip {
    ClipId clip{};
    Vec2 at = {0, 0};
    float travel = 0.0f;
    bool operator==(const GraphClip&) const = default;
};

LIMN_FIELDS(GraphClip) {
    LIMN_FIELD(clip, "a clip of the level, by name");
    LIMN_FIELD(at, "values of the parameters x and y at which it plays alone");
    LIMN_FIELD(
        travel, "way that one cycle of it covers; with x = speed, cycles are as fast as needed",
        "m", 0, 1000);
}

struct GraphState {
    std::string name{};
    std::vector<GraphClip> clips{};
    GraphParameter x = GraphParameter::None;
    GraphParameter y = GraphParameter::None;
    float speed = 1.0f;
    bool loop = true;
    bool operator==(const GraphState&) const = default;
};

LIMN_FIELDS(GraphState) {
    LIMN_FIELD(name, "for transitions");
    LIMN_FIELD(clips, "one, or several that x and y blend; none: the rest pose");
    LIMN_FIELD(
        x, .doc = "what blends the clips along the first axis",
        .values = "none speed turn slope amount");
    LIMN_FIELD(
        y, .doc = "and along the second; none: a blend space of one dimension",
        .values = "none speed turn slope amount");
    LIMN_FIELD(speed, "playback rate; negative: backward", "", -100, 100);
    LIMN_FIELD(loop, "loops; otherwise holds the last pose and sends the event \"end\"");
}

enum class TransitionBlend : std::uint8_t {
    Inertialize,  ///< only the new state plays; the difference to the old pose decays (Bollo 2018)
    Crossfade,    ///< both states play, and the pose is interpolated between them
};

enum class StartPhase : std::uint8_t { Beginning, Same, Time };

/// From one state to another: when `event` arrives and `parameter` is in its interval.
struct GraphTransition {
    std::string from{};
    std::string event{};
    GraphParameter parameter = GraphParameter::None;
    float above = -1e6f;
    float below = 1e6f;
    std::string to{};
    float duration = 0.25f;
    TransitionBlend blend = TransitionBlend::Inertialize;
    bool smooth = false;
    StartPhase start = StartPhase::Beginning;
    float time = 0.0f;
    bool restart = false;
    bool interruptible = true;
    bool operator==(const GraphTransition&) const = default;
};

LIMN_FIELDS(GraphTransition) {
    LIMN_FIELD(from, "a state; empty: any");
    LIMN_FIELD(
        event, "event that triggers it; \"end\": the clip has ended; empty: the parameter alone");
    LIMN_FIELD(
        parameter, .doc = "must be between `above` and `below`",
        .values = "none speed turn slope amount");
    LIMN_FIELD(above, "limit of the parameter", "", -1e6, 1e6);
    LIMN_FIELD(below, "limit of the parameter", "", -1e6, 1e6);
    LIMN_FIELD(to, "the next state");
    LIMN_FIELD(duration, "of the blend; 0: a cut", "s", 0, 60);
    LIMN_FIELD(
        blend, .doc = "the difference of the poses decays, or both play",
        .values = "inertialize crossfade");
    LIMN_FIELD(smooth, "the crossfade eases in and out");
    LIMN_FIELD(
        start, .doc = "where the next state begins: same = its feet as the old one's",
        .values = "beginning same time");
    LIMN_FIELD(time, "in its clip, for start = time", "s", 0, 3600);
    LIMN_FIELD(restart, "starts over if it is the current state");
    LIMN_FIELD(interruptible, "others may begin before it is over; otherwise events wait");
}

enum class LayerMode : std::uint8_t { Override, Additive };

/// A clip on top of the states, for some of the joints.
struct GraphLayer {
    std::string name{};
    ClipId clip{};
    LayerMode mode = LayerMode::Override;
    bool from_rest = false;
    std::vector<std::string> joints{};
    std::vector<std::string> without{};
    float weight = 1.0f;
    GraphParameter parameter = GraphParameter::None;
    std::string event{};
    std::string until{};
    float fade = 0.2f;
    float speed = 1.0f;
    bool loop = true;
};

LIMN_FIELDS(GraphLayer) {
    LIMN_FIELD(name, "for people");
    LIMN_FIELD(clip, "a clip of the level, by name");
    LIMN_FIELD(
        mode, .doc = "replaces the pose, or adds the clip's difference from its first pose",
        .values = "override additive");
    LIMN_FIELD(from_rest, "additive: the difference from the rest pose instead");
    LIMN_FIELD(joints, "that it moves, with their descendants, by name; empty: all");
    LIMN_FIELD(without, "except these, with their descendants");
    LIMN_FIELD(weight, "of the layer; additive: factor of the difference", "", -10, 10);
    LIMN_FIELD(
        parameter, .doc = "that the weight is multiplied by",
        .values = "none speed turn slope amount");
    LIMN_FIELD(event, "event that starts it; empty: always plays");
    LIMN_FIELD(until, "event that ends it; without one, a clip that does not loop ends it");
    LIMN_FIELD(fade, "time in which it appears and disappears", "s", 0, 60);
    LIMN_FIELD(speed, "playback rate", "", -100, 100);
    LIMN_FIELD(loop, "loops");
}

/// Largest number of clips of a state.
inline constexpr std::size_t kMaxGraphClips = 16;

/// A motion graph; only a MotionGraphEdit changes it. The first state is the initial one.
struct MotionGraphData {
    std::string name{};
    std::vector<GraphState> states{};
    std::vector<GraphTransition> transitions{};
    std::vector<GraphLayer> layers{};
    std::vector<std::string> feet{};
};

LIMN_FIELDS(MotionGraphData) {
    LIMN_FIELD(states, "the first one is the initial one");
    LIMN_FIELD(transitions, "the first that fits is taken; those of a state before those of any");
    LIMN_FIELD(layers, "on top of the states, in this order");
    LIMN_FIELD(
        feet, "joints whose contacts synchronize the clips, in the order in which they touch down");
}

/// What replaces a motion graph while characters play it.
struct MotionGraphEdit {
    MotionGraphId graph{};   ///< which one
    MotionGraphData data{};  ///< valid: its transitions lead to states that exist
};

/// Resource: all motion graphs. Entries are only appended, and indices never change.
struct MotionGraphs {
    std::vector<MotionGraphData> graphs{};
    std::vector<MotionGraphEdit> edits{};  ///< of the next step, in this order
};

/// How the entity moves over the ground.
enum class RootMotion : std::uint8_t {
    InPlace,    ///< something else moves it
    FromClip,   ///< as the root joint of the clips moves, which then stays above the origin
    FromSpeed,  ///< ahead at `speed`, turning at `turn`
};

/// With a Skeleton: a motion graph animates it instead of a ClipPlayer. With a MoveIntent, that
/// determines `speed` and `turn`.
struct MotionGraph {
    MotionGraphId graph{};
    float speed = 0.0f;
    float turn = 0.0f;
    float slope = 0.0f;
    float amount = 0.0f;
    float phase = 0.0f;
    RootMotion root = RootMotion::InPlace;
    float acceleration = 3.0f;
    float turn_rate = 3.0f;
    std::vector<std::string> events{};
};

LIMN_FIELDS(MotionGraph) {
    LIMN_FIELD(graph, "a motion graph of the level, by name");
    LIMN_FIELD(speed, "parameter: forward speed", "m/s", -1000, 1000);
    LIMN_FIELD(turn, "parameter: rate of the turn to the left", "rad/s", -100, 100);
    LIMN_FIELD(slope, "parameter: slope of the ground, positive uphill", "rad", -1.6, 1.6);
    LIMN_FIELD(amount, "parameter for anything else", "", -1000, 1000);
    LIMN_FIELD(phase, "of the initial state at the start: fraction of its cycle", "", 0, 1);
    LIMN_FIELD(
        root, .doc = "what moves the entity: something else, its clips, or speed and turn",
        .values = "in_place from_clip from_speed");
    LIMN_FIELD(acceleration, "with a move_intent: how fast the speed changes", "m/s2", 0, 1000);
    LIMN_FIELD(turn_rate, "with a move_intent: largest rate of the turn", "rad/s", 0, 100);
    LIMN_FIELD(events, "events for the next step; those that no transition knows are ignored");
}

inline constexpr std::uint32_t kNoGraphState = 0xffffffffu;
inline constexpr std::uint32_t kFrozenPose = 0xfffffffeu;  ///< a pose, not a state

/// A state at a phase of its cycle, 0 .. 1. Footfalls divide it evenly: with two feet, the first
/// touches down at 0, the second at 0.5, whatever the clip.
struct GraphPlayback {
    std::uint32_t state = kNoGraphState;
    float phase = 0.0f;
};

LIMN_FIELDS(GraphPlayback) {
    LIMN_FIELD(state, "index of the state");
    LIMN_FIELD(phase, "of its cycle", "", 0, 1);
}

/// Playback of a GraphLayer.
struct LayerPlayback {
    float time = 0.0f;
    float fade = 0.0f;
    std::uint32_t playing = 0;
};

LIMN_FIELDS(LayerPlayback) {
    LIMN_FIELD(time, "in the clip", "s");
    LIMN_FIELD(fade, "from 0, invisible, to 1", "", 0, 1);
    LIMN_FIELD(playing, "1 between its events", "", 0, 1);
}

/// What the displayed pose is off the played one at the beginning of a transition.
struct InertialOffset {
    Vec3 offset = {0, 0, 0};
    Vec3 rate = {0, 0, 0};
};

LIMN_FIELDS(InertialOffset) {
    LIMN_FIELD(offset, "rotation vector [rad], translation [m] or, along x, morph weight");
    LIMN_FIELD(rate, "its derivative", "1/s");
}

/// What a MotionGraph plays: all that a snapshot needs to continue in the middle of a transition.
struct MotionGraphState {
    MotionGraphId graph{};
    GraphPlayback current{};
    GraphPlayback source{};
    std::uint32_t transition = kNoGraphState;
    float clock = 0.0f;
    std::uint32_t cut = 0;
    std::vector<InertialOffset> turns{};
    std::vector<std::uint16_t> shifted{};
    std::vector<InertialOffset> shifts{};
    std::vector<InertialOffset> morphs{};
    std::vector<Vec3> frozen_translations{};
    std::vector<Quat> frozen_rotations{};
    std::vector<Vec3> frozen_scales{};
    std::vector<float> frozen_weights{};
    std::vector<LayerPlayback> layers{};
    std::vector<std::string> fired{};
};

LIMN_FIELDS(MotionGraphState) {
    LIMN_FIELD(graph, "that plays; another one of the MotionGraph is blended to");
    LIMN_FIELD(current, "the state that plays");
    LIMN_FIELD(source, "of a crossfade");
    LIMN_FIELD(transition, "index of the transition that is not over");
    LIMN_FIELD(clock, "since it began", "s");
    LIMN_FIELD(cut, "1: the last step changed the pose without a blend", "", 0, 1);
    LIMN_FIELD(turns, "inertialized: rotation of each joint");
    LIMN_FIELD(shifted, "joints with an inertialized translation");
    LIMN_FIELD(shifts, "their offsets");
    LIMN_FIELD(morphs, "inertialized: offset of each morph weight");
    LIMN_FIELD(frozen_translations, "pose from which an interrupted transition continues", "m");
    LIMN_FIELD(frozen_rotations, "likewise");
    LIMN_FIELD(frozen_scales, "likewise");
    LIMN_FIELD(frozen_weights, "likewise");
    LIMN_FIELD(layers, "playback of the layers");
    LIMN_FIELD(fired, "names of the clip's events in the last step");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<MotionGraphState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// Amplitude of a joint and its descendants about their mean pose.
struct MotionGain {
    std::string joint{};
    float gain = 1.0f;
};

LIMN_FIELDS(MotionGain) {
    LIMN_FIELD(joint, "by name");
    LIMN_FIELD(
        gain, "0: the mean pose, 1: as in the clip, 2: twice as far from the mean", "", 0, 4);
}

/// With a MotionGraph: how it moves. Gains of legs change strides, so that feet slide unless they
/// are planted by inverse kinematics.
struct MotionStyle {
    float speed = 1.0f;
    std::vector<MotionGain> gains{};
};

LIMN_FIELDS(MotionStyle) {
    LIMN_FIELD(
        speed, "playback rate of the states, and factor of the speed over ground", "", 0, 10);
    LIMN_FIELD(gains, "amplitudes; a later one replaces an earlier one of an ancestor");
}

/// Value of a parameter; 0 for None.
[[nodiscard]] inline float parameter_of(const MotionGraph& graph, GraphParameter parameter) {
    switch (parameter) {
    case GraphParameter::None:
        return 0.0f;
    case GraphParameter::Speed:
        return graph.speed;
    case GraphParameter::Turn:
        return graph.turn;
    case GraphParameter::Slope:
        return graph.slope;
    case GraphParameter::Amount:
        return graph.amount;
    }
    return 0.0f;
}

/// Index of the state with this name; kNoGraphState if there is none.
[[nodiscard]] inline std::uint32_t
find_graph_state(const MotionGraphData& graph, std::string_view name) {
    for (std::uint32_t i = 0; i < graph.states.size(); ++i) {
        if (graph.states[i].name == name) {
            return i;
        }
    }
    return kNoGraphState;
}

}  // namespace limn
