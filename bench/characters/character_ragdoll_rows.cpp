#include "bench/characters/character_crowd.h"
#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "ecs/base/jobs.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/ragdoll.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/update_world.h"

#include <fmt/format.h>

#include <cstddef>

namespace limn::bench {

void add_ragdoll_rows(CharacterBench& bench);

namespace {

constexpr std::size_t kFallers = 16;
constexpr int kFallSteps = 90;

/// Skeletons that fall to the ground from the same state, 1.5 s.
void let_fall(bool active) {
    World world;
    Assets assets;
    assets.skeletons.push_back(make_bench_skeleton(24));
    world.insert_resource(std::move(assets));
    world.create(Transform{}, Walkable{});
    for (std::size_t i = 0; i < kFallers; ++i) {
        const auto x = static_cast<float>(i);
        world.create(
            Transform{.position = {3 * x, 0.5f, 0}}, Skeleton{{0}},
            Ragdoll{.active = active, .collapse = 0, .push = {0, 0, active ? 0.1f * x : 0.0f}});
    }
    Schedule schedule = make_world_schedule();
    for (int i = 0; i < kFallSteps; ++i) {
        step_world(world, schedule);
    }
}

}  // namespace

void add_ragdoll_rows(CharacterBench& bench) {
    const int before = thread_count();
    set_thread_count(1);
    const int repeats = bench.repeats / 20;
    const auto [active, idle] = race(
        thread_seconds, repeats, [] { let_fall(true); }, [] { let_fall(false); });
    set_thread_count(before);
    bench.add(
        {.gate = "",
         .name = fmt::format("ragdoll of a skeleton of 24 joints, a step of 1/60 s"),
         .ours = 1e6 * (active - idle) / (kFallers * kFallSteps),
         .unit = "us"});
}

}  // namespace limn::bench
