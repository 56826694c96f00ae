#include "bench/characters/character_crowd.h"
#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "ecs/base/jobs.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/world.h"
#include "systems/animation/graph/motion_graph_system.h"
#include "systems/animation/pose_system.h"

#include <cstdint>
#include <string>

namespace limn::bench {

void add_graph_rows(CharacterBench& bench);

namespace {

constexpr std::size_t kCount = 200;
constexpr std::size_t kJoints = 67;

MotionGraphData make_bench_graph(TransitionBlend blend) {
    MotionGraphData graph;
    graph.states = {
        {.name = "first", .clips = {{{0}, {0, 0}, 0}}},
        {.name = "second", .clips = {{{1}, {0, 0}, 0}}},
        {.name = "blended",
         .clips = {{{2}, {0, 0}, 0}, {{3}, {1, 0}, 0}},
         .x = GraphParameter::Amount}};
    graph.transitions = {
        {.event = "second", .to = "second", .duration = 1e6f, .blend = blend},
        {.event = "blended", .to = "blended", .duration = 0}};
    return graph;
}

/// Characters that received `event` and are in what follows from it.
void fill_graph_world(World& world, TransitionBlend blend, const char* event) {
    Assets assets;
    assets.skeletons.push_back(make_bench_skeleton(kJoints));
    for (std::uint64_t i = 0; i < 4; ++i) {
        assets.clips.push_back(make_bench_clip(assets.skeletons[0], i));
    }
    world.insert_resource(std::move(assets));
    world.insert_resource(FrameTime{});
    world.insert_resource(MotionGraphs{{make_bench_graph(blend)}});
    world.insert_resource(MotionPlans{});
    for (std::size_t i = 0; i < kCount; ++i) {
        world.create(
            Transform{}, Skeleton{{0}}, Pose{},
            MotionGraph{.graph = {0}, .amount = 0.5f, .phase = static_cast<float>(i) / kCount});
    }
    world.run(add_motion_states);
    world.run(prepare_motion_plans);
    world.query<MotionGraph>().each([&](MotionGraph& graph) { graph.events = {event}; });
    world.run(update_motion_graphs);
    world.run(update_poses);
}

void fill_clip_world(World& world) {
    Assets assets;
    assets.skeletons.push_back(make_bench_skeleton(kJoints));
    assets.clips.push_back(make_bench_clip(assets.skeletons[0], 0));
    world.insert_resource(std::move(assets));
    world.insert_resource(FrameTime{});
    for (std::size_t i = 0; i < kCount; ++i) {
        world.create(
            Skeleton{{0}}, Pose{},
            ClipPlayer{.clip = {0}, .time = 2.0f * static_cast<float>(i) / kCount});
    }
    world.run(update_poses);
}

}  // namespace

void add_graph_rows(CharacterBench& bench) {
    const int before = thread_count();
    set_thread_count(1);
    World clip;
    World one;
    World inertial;
    World crossfade;
    World space;
    fill_clip_world(clip);
    fill_graph_world(one, TransitionBlend::Inertialize, "none");
    fill_graph_world(inertial, TransitionBlend::Inertialize, "second");
    fill_graph_world(crossfade, TransitionBlend::Crossfade, "second");
    fill_graph_world(space, TransitionBlend::Inertialize, "blended");
    const auto poses = [](World& world) { return [&world] { world.run(update_poses); }; };
    const auto times = race(
        thread_seconds, bench.repeats, poses(clip), poses(one), poses(inertial), poses(crossfade),
        poses(space), [&] { space.run(update_motion_graphs); });
    constexpr double kNs = 1e9 / (kCount * kJoints);
    const auto add = [&](const char* name, double seconds) {
        bench.add(
            {.gate = "",
             .name = std::string("motion graph, pose: ") + name + ", per joint",
             .ours = seconds * kNs,
             .reference = times[0] * kNs,
             .against = "a clip player"});
    };
    add("one clip", times[1]);
    add("an inertialized transition", times[2]);
    add("a crossfade", times[3]);
    add("a blend space of two clips", times[4]);
    bench.add(
        {.gate = "",
         .name = "motion graph, step of a blend space, per character",
         .ours = times[5] * 1e9 / kCount,
         .reference = times[0] * 1e9 / kCount,
         .against = "the pose of a clip player"});
    set_thread_count(before);
}

}  // namespace limn::bench
