#include "ecs/base/jobs.h"
#include "ecs/snapshot.h"
#include "tests/near.h"
#include "tests/systems/motion_graph_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::graph_edit_test {

using namespace limn::test;
using enum TransitionBlend;

namespace {

MotionGraphData make_graph() {
    MotionGraphData graph;
    graph.states = {make_state("still", kStill), make_state("swing", kSwing)};
    graph.states.push_back(make_state("raised", kForty));
    graph.transitions = {
        make_exit("", "swing", "swing", Inertialize),
        make_exit("", "raise", "raised", Crossfade, 0.4f)};
    graph.layers = {
        {.name = "nod", .clip = {kNod}, .joints = {"joint 2"}},
        {.name = "wave", .clip = {kNod}, .joints = {"joint 2"}}};
    return graph;
}

void edit(World& world, MotionGraphData graph) {
    world.resource<MotionGraphs>().edits.push_back({{0}, std::move(graph)});
}

/// In "raised", at an angle of 40 degrees.
struct RaisedStage : GraphStage {
    RaisedStage() : GraphStage(make_graph()) {
        start();
        send("raise");
        step(40);
        REQUIRE(playing() == "raised");
        REQUIRE(angle() == near(40));
    }
};

/// The largest change of the angle in a step [deg], and the last angle.
std::pair<float, float> follow_angle(GraphStage& stage, int steps) {
    float largest = 0;
    for (int i = 0; i < steps; ++i) {
        const float before = stage.angle();
        stage.step();
        largest = std::max(largest, std::abs(stage.angle() - before));
    }
    return {largest, stage.angle()};
}

std::vector<std::uint64_t> herd_hashes(int threads) {
    set_thread_count(threads);
    GraphStage stage(make_graph());
    for (int i = 0; i < 100; ++i) {
        stage.world.create(
            Transform{}, Skeleton{{0}},
            MotionGraph{
                .graph = {0},
                .phase = 0.01f * static_cast<float>(i),
                .events = {i % 2 == 0 ? "raise" : "swing"}});
    }
    stage.start();
    stage.schedule.set_always_parallel(threads > 1);
    std::vector<std::uint64_t> all;
    for (int i = 0; i < 30; ++i) {
        if (i % 10 == 5) {
            MotionGraphData graph = make_graph();
            graph.states.erase(graph.states.begin() + 1 + i / 10 % 2);
            graph.transitions.clear();
            edit(stage.world, graph);
        }
        stage.step();
        all.push_back(state_hash(stage.world));
    }
    return all;
}

}  // namespace

TEST_CASE(
    "graph edit: a new transition is taken, and what plays goes on"
    * technique("char.motion-select")) {
    GraphStage stage(make_graph());
    stage.start();
    stage.send("swing");
    stage.step(36);
    GraphStage other(make_graph());
    other.start();
    other.send("swing");
    other.step(36);
    MotionGraphData graph = make_graph();
    // All indices change.
    graph.states.insert(graph.states.begin(), make_state("first", kOnce, false));
    graph.transitions.insert(
        graph.transitions.begin(), make_exit("swing", "jump", "first", Inertialize));
    edit(stage.world, graph);
    stage.step();
    other.step();
    CHECK(stage.playing() == "swing");
    CHECK(stage.state().current.state == 2);
    CHECK(stage.state().transition == kNoGraphState);
    CHECK(stage.state().current.phase == other.state().current.phase);
    CHECK(stage.angle() == other.angle());
    CHECK(stage.world.resource<MotionGraphs>().graphs[0].transitions.size() == 3);
    CHECK(stage.world.resource<MotionGraphs>().edits.empty());
    stage.send("jump");
    stage.step();
    CHECK(stage.playing() == "first");
}

TEST_CASE("graph edit: a transition that is not over goes on, with the same bits") {
    for (const char* const event : {"swing", "raise"}) {
        GraphStage stage(make_graph());
        GraphStage other(make_graph());
        for (GraphStage* const each : {&stage, &other}) {
            each->start();
            each->send(event);
            each->step(5);
            REQUIRE(each->state().transition != kNoGraphState);
        }
        MotionGraphData graph = make_graph();
        graph.states.insert(graph.states.begin(), make_state("first", kOnce, false));
        std::swap(graph.transitions[0], graph.transitions[1]);
        edit(stage.world, graph);
        for (int i = 0; i < 20; ++i) {
            stage.step();
            other.step();
            CHECK(stage.angle() == other.angle());
        }
    }
}

TEST_CASE("graph edit: who is in a removed state blends to the initial one without a jump") {
    RaisedStage stage;
    MotionGraphData graph = make_graph();
    graph.states.pop_back();
    graph.transitions.pop_back();
    edit(stage.world, graph);
    stage.step();
    CHECK(stage.playing() == "still");
    CHECK(stage.state().cut == 0);
    CHECK(stage.angle() > 39.5f);
    const auto [largest, last] = follow_angle(stage, 15);
    CHECK(largest < 40 * 2.0f / 16);  // the polynomial's largest rate is 1.875
    CHECK(std::abs(last) < 1e-3f);
    CHECK(stage.state().transition == kNoGraphState);
    // What it blended by is no longer there after the next edit.
    edit(stage.world, graph);
    stage.step();
    CHECK(stage.world.resource<MotionGraphs>().graphs[0].transitions.size() == 1);
}

TEST_CASE("graph edit: a second edit in the middle of the blend does not jump either") {
    RaisedStage stage;
    MotionGraphData graph = make_graph();
    graph.states.pop_back();
    graph.transitions.pop_back();
    edit(stage.world, graph);
    stage.step(6);
    CHECK(stage.angle() > 10);
    graph.transitions[0].duration = 0.7f;
    graph.states[0].speed = 2;
    edit(stage.world, graph);
    const auto [largest, last] = follow_angle(stage, 40);
    CHECK(largest < 40 * 2.0f / 16);
    CHECK(std::abs(last) < 1e-3f);
}

TEST_CASE("graph edit: other clips of the state that plays fade in") {
    RaisedStage stage;
    const float phase = stage.state().current.phase;
    MotionGraphData graph = make_graph();
    graph.states[2].clips[0].clip = {kStill};
    edit(stage.world, graph);
    stage.step();
    CHECK(stage.playing() == "raised");
    CHECK(stage.state().current.phase == near(phase + 1.0 / 64));
    CHECK(stage.angle() > 39.5f);
    CHECK(std::abs(follow_angle(stage, 15).second) < 1e-3f);
}

TEST_CASE("graph edit: layers are found by name, and new ones fade in") {
    GraphStage stage(make_graph());
    stage.start();
    stage.step(9);
    stage.state().layers[1].time = 0.25f;
    MotionGraphData graph = make_graph();
    graph.layers[0] = {.name = "new", .clip = {kNod}, .joints = {"joint 2"}, .fade = 0.25f};
    std::swap(graph.layers[0], graph.layers[1]);
    edit(stage.world, graph);
    stage.step();
    REQUIRE(stage.state().layers.size() == 2);
    CHECK(stage.state().layers[0].time == near(0.25 + 1.0 / 64));
    CHECK(stage.state().layers[0].fade == 1);
    CHECK(stage.state().layers[1].fade == near(1.0 / 16));
    graph.layers.clear();
    edit(stage.world, graph);
    stage.step();
    CHECK(stage.state().layers.empty());
}

TEST_CASE("graph edit: the same bits on 1, 2, 3 and 7 threads") {
    const int before = thread_count();
    const std::vector<std::uint64_t> one = herd_hashes(1);
    for (const int threads : {2, 3, 7}) {
        CHECK(herd_hashes(threads) == one);
    }
    set_thread_count(before);
    CHECK(one[4] != one[5]);
}

}  // namespace limn::graph_edit_test
