#pragma once

#include "ecs/components/all.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/time.h"
#include "systems/animation/graph/motion_graph_system.h"
#include "systems/update_world.h"
#include "tests/systems/clip_fixture.h"

#include <cmath>
#include <string>
#include <vector>

namespace limn::test {

/// Clips of a chain of four joints for motion graphs. Joint 1 shows which one plays.
enum TestClip : std::uint32_t {
    kStill,    ///< 0 deg, 1 s
    kForty,    ///< 40 deg, 1 s
    kSwing,    ///< 20 deg sine in 1 s
    kSlow,     ///< 10 deg sine in 2 s
    kOnce,     ///< 0 to 90 deg in 0.5 s
    kStride,   ///< the root moves 2 m along z in 1 s; joints 2 and 3 touch down at 0.2, 0.6 s
    kGallop,   ///< 3 m in 0.5 s; they touch down at 0.3, 0.35 s
    kCircle,   ///< the root turns 90 deg to the left on a circle of 1 m, in 1 s
    kNod,      ///< joint 2, 0 to 30 deg in 0.4 s
    kForeign,  ///< of another skeleton: joint 9
};

inline ClipData make_sine(float degrees, float duration) {
    std::vector<float> times;
    std::vector<float> angles;
    for (int key = 0; key <= 64; ++key) {
        const float u = static_cast<float>(key) / 64.0f;
        times.push_back(u * duration);
        angles.push_back(degrees * std::sin(2 * kPi * u));
    }
    return make_turn(times, angles, 1);
}

inline ClipData make_travel(float way, float duration, float second, float first) {
    ClipData clip = make_turn({0, duration}, {0, 0}, 1);
    clip.sheets[0].translating = {0};
    clip.sheets[0].translations = {Vec3(0.1f, 0.5f, 1), Vec3(0.1f, 0.5f, 1 + way)};
    clip.contacts = {{2, first, first + 0.05f}, {3, second, second + 0.05f}};
    return clip;
}

inline ClipData make_circle() {
    ClipData clip;
    clip.duration = 1;
    ClipSheet& sheet = clip.sheets.emplace_back();
    sheet.rotating = {0};
    sheet.translating = {0};
    for (int key = 0; key <= 64; ++key) {
        const float angle = 0.5f * kPi * static_cast<float>(key) / 64.0f;
        sheet.times.push_back(static_cast<float>(key) / 64.0f);
        sheet.rotations.push_back(rotation_about({0, 1, 0}, angle));
        sheet.translations.emplace_back(1 - std::cos(angle), 0, std::sin(angle));
    }
    return clip;
}

inline Assets make_graph_assets() {
    Assets assets;
    assets.skeletons.push_back(make_chain(4));
    assets.clips = {
        make_turn({0, 1}, {0, 0}, 1),
        make_turn({0, 1}, {40, 40}, 1),
        make_sine(20, 1),
        make_sine(10, 2),
        make_turn({0, 0.5f}, {0, 90}, 1),
        make_travel(2, 1, 0.6f, 0.2f),
        make_travel(3, 0.5f, 0.35f, 0.3f),
        make_circle(),
        make_turn({0, 0.4f}, {0, 30}, 2),
        make_turn({0, 1}, {0, 30}, 9)};
    assets.clips[kSwing].events = {{"left", 0.25f}, {"right", 0.75f}};
    return assets;
}

inline GraphState
make_state(const char* name, std::uint32_t clip, bool loop = true, float speed = 1.0f) {
    return {.name = name, .clips = {{{clip}, {0, 0}, 0}}, .speed = speed, .loop = loop};
}

inline GraphTransition make_exit(
    const char* from, const char* event, const char* to, TransitionBlend blend,
    float duration = 0.25f) {
    return {.from = from, .event = event, .to = to, .duration = duration, .blend = blend};
}

/// A world with one character that has the graph.
struct GraphStage {
    World world;
    Schedule schedule = make_world_schedule();
    Entity character;

    explicit GraphStage(MotionGraphData graph, float step = 1.0f / 64.0f) {
        register_all_components();
        world.insert_resource(make_graph_assets());
        world.insert_resource(MotionGraphs{{std::move(graph)}});

        world.insert_resource(FrameTime{.step = step});
        character = world.create(Transform{}, Skeleton{{0}}, MotionGraph{.graph = {0}});
    }
    void start() { start_world(world); }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    MotionGraph& graph() { return world.get<MotionGraph>(character); }
    MotionGraphState& state() { return world.get<MotionGraphState>(character); }
    void send(const char* event) { graph().events.emplace_back(event); }
    std::string playing() {
        const MotionGraphData& data = world.resource<MotionGraphs>().graphs[0];
        const std::uint32_t index = state().current.state;
        return index < data.states.size() ? data.states[index].name : "";
    }
    /// Angle of joint 1 about z [deg].
    float angle(std::size_t joint = 1) {
        const Affine& m = world.get<const Pose>(character).joints[joint];
        return std::atan2(m.row[1].x, m.row[0].x) * 180.0f / kPi;
    }
    const Pose& pose() { return world.get<const Pose>(character); }
    Vec3 position() { return world.get<const Transform>(character).position; }
};

}  // namespace limn::test
