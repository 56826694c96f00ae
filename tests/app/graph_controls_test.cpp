#include "content/app/panels/graph_controls.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::graph_controls_test {

using namespace limn::test;

TEST_CASE(
    "graph controls: state, weights and transition of a character, and its events"
    * technique("char.motion-select")) {
    World world;
    Assets& assets = world.insert_resource(Assets{});
    assets.skeletons.push_back({"one", {"root"}, {-1}, {{Vec3(0)}, {Quat(1, 0, 0, 0)}, {Vec3(1)}}});
    for (const char* const name : {"walk", "run"}) {
        ClipData clip;
        clip.name = name;
        clip.duration = 1;
        clip.sheets.emplace_back().times = {0, 1};
        assets.clips.push_back(clip);
    }
    MotionGraphData graph;
    graph.states = {
        {.name = "stand"},
        {.name = "move",
         .clips = {{{0}, {1, 0}, 0}, {{1}, {3, 0}, 0}},
         .x = GraphParameter::Speed}};
    graph.transitions = {
        {.from = "stand", .event = "go", .to = "move", .duration = 0.5f},
        {.from = "move", .event = "end", .to = "stand"},
        {.event = "halt", .to = "stand"},
        {.from = "move", .event = "go", .to = "stand"}};
    graph.layers = {{.name = "wave", .event = "wave", .until = "halt"}};
    world.insert_resource(MotionGraphs{{graph}});
    world.insert_resource(FrameTime{.step = 0.125f});
    const Entity character =
        world.create(Transform{}, Skeleton{{0}}, MotionGraph{.graph = {0}, .speed = 1.5f});
    CHECK(view_graph(world, character).events.empty());  // no state yet
    start_world(world);
    Schedule schedule = make_world_schedule();
    CHECK(view_graph(world, character).state == "stand");
    CHECK(view_graph(world, character).events == std::vector<std::string>{"go", "halt", "wave"});

    send_graph_event(world, character, "go");
    step_world(world, schedule);
    step_world(world, schedule);
    const GraphView view = view_graph(world, character);
    CHECK(view.state == "stand -> move");
    CHECK(view.clock == near(0.25));
    CHECK(view.duration == 0.5f);
    REQUIRE(view.clips.size() == 2);
    CHECK(view.clips[0].first == "walk");
    CHECK(view.clips[0].second == near(0.75));
    CHECK(view.clips[1].second == near(0.25));
    REQUIRE(view.layers.size() == 1);
    CHECK(view.layers[0].first == "wave");
    CHECK(view.layers[0].second == 0);

    const Entity other = world.create(Transform{});
    send_graph_event(world, other, "go");
    CHECK(view_graph(world, other).state.empty());
}

}  // namespace limn::graph_controls_test
