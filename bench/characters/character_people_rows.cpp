#include "bench/characters/character_crowd.h"
#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "bench/oracles/walker_motion.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/crowd.h"
#include "ecs/components/crowd_pose.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "systems/update_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

// Whole steps of a world: people who walk to goals of their own, plant their feet and avoid one
// another, on ground.

namespace limn::bench {

void add_people_rows(CharacterBench& bench);

namespace {

constexpr std::size_t kPeople = 2000;
constexpr std::size_t kPersonJoints = 67;
constexpr float kPeopleDensity = 0.25f;  // [1/m2]

/// The walker of the oracles, with joints of hands up to the number that the targets count with.
SkeletonData make_person_skeleton() {
    SkeletonData skeleton = oracle::make_walker();
    while (skeleton.joints.size() < kPersonJoints) {
        skeleton.joints.push_back(fmt::format("Finger{}", skeleton.joints.size()));
        skeleton.parents.push_back(static_cast<std::int32_t>(skeleton.joints.size() / 2));
        skeleton.rest.translations.emplace_back(0, 0.02f, 0);
        skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
        skeleton.rest.scales.emplace_back(1, 1, 1);
    }
    return skeleton;
}

/// Some seconds after they set off.
struct PeopleWorld {
    World world;
    Schedule schedule = make_world_schedule();

    explicit PeopleWorld(std::size_t count) {
        Assets assets;
        assets.skeletons.push_back(make_person_skeleton());
        world.insert_resource(std::move(assets));
        const Entity style = world.create(Walk{.speed = 1.3f});
        world.create(Transform{}, Walkable{});
        const float half = 0.5f * std::sqrt(static_cast<float>(count) / kPeopleDensity);
        Random random(7, 0, name_hash("bench people"), 0);
        const auto place = [&] {
            const float x = random.uniform(-half, half);
            const float z = random.uniform(-half, half);
            return Vec3(x, 0, z);
        };
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 from = place();
            const Vec3 to = 4.0f * place();  // nobody arrives
            world.create(
                Transform{.position = from}, Skeleton{{0}}, CrowdWalk{.style = style}, CrowdPose{},
                CrowdAgent{.speed = 1.2f}, CrowdGoal{.point = to});
        }
        for (int i = 0; i < 60; ++i) {
            step();
        }
    }
    void step() { step_world(world, schedule); }
};

double measure_step(CharacterBench& bench, PeopleWorld& people) {
    return race(wall_seconds, std::min(bench.repeats, 40), [&] { people.step(); })[0];
}

/// Two samples, blended, to matrices, of 2000 characters, in plain C++ [s].
double measure_scalar_chain(CharacterBench& bench) {
    BenchCrowd crowd(kPersonJoints, kPeople);
    std::vector<float> buffer;
    return race(wall_seconds, std::min(bench.repeats, 20), [&] { pose_by_hand(crowd, buffer); })[0];
}

}  // namespace

void add_people_rows(CharacterBench& bench) {
    register_all_components();
    const int before = thread_count();
    const auto world = std::make_unique<PeopleWorld>(kPeople);
    set_thread_count(1);
    const double one = measure_step(bench, *world);
    const double chain = measure_scalar_chain(bench);
    set_thread_count(2);
    const double two = measure_step(bench, *world);
    bench.add(
        {.gate = "19",
         .name = "a step of 2000 people of 67 joints, one thread",
         .ours = 1e3 * one,
         .reference = 1e3 * chain,
         .against = "chain by hand",
         .unit = "ms",
         .limit = 0.5,
         .stretch = 0.35,
         .peer = "1.9",
         .vectors = true});
    bench.add(
        {.gate = "22",
         .name = "the same: one thread over two",
         .ours = 1e3 * one,
         .reference = 1e3 * two,
         .against = "two threads",
         .unit = "ms",
         .limit = 1.8,
         .stretch = 1.95,
         .at_least = true});
    bench.add(
        {.gate = "",
         .name = "2000 people walk, plant their feet, avoid one another: two threads",
         .ours = 1e3 * two,
         .unit = "ms",
         .limit = 8});
    double thousand = 0;
    for (const std::size_t count : {1u, 10u, 100u, 1000u, 10000u}) {
        PeopleWorld people(count);
        const double each = 1e9 * measure_step(bench, people) / static_cast<double>(count);
        thousand = count == 1000 ? each : thousand;
        bench.add(
            {.gate = "",
             .name = fmt::format("a step of {} people, each", count),
             .ours = each,
             .reference = count == 10000 ? thousand : 0,
             .against = count == 10000 ? "1000 people" : "",
             .limit = count == 10000 ? 1.3 : 0});
    }
    set_thread_count(before);
}

}  // namespace limn::bench
