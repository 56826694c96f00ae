#include "bench/characters/character_crowd.h"
#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/world.h"
#include "systems/animation/crowd_pose_system.h"
#include "systems/animation/pose_system.h"

#include <cstdint>

namespace limn::bench {

void add_world_rows(CharacterBench& bench);

namespace {

constexpr std::size_t kCount = 2000;
constexpr std::size_t kJoints = 67;

/// Characters of a world that play eight clips at random times.
void fill_world(World& world, bool crowd) {
    Assets assets;
    assets.skeletons.push_back(make_bench_skeleton(kJoints));
    for (std::uint64_t i = 0; i < kBenchClips; ++i) {
        assets.clips.push_back(make_bench_clip(assets.skeletons[0], i));
    }
    world.insert_resource(std::move(assets));
    world.insert_resource(FrameTime{});
    world.insert_resource(CrowdLibrary{});
    Random random(1, 0, name_hash("bench world"), 0);
    for (std::size_t i = 0; i < kCount; ++i) {
        const Entity entity = world.create(
            Skeleton{{0}},
            ClipPlayer{.clip = {random.below(kBenchClips)}, .time = random.uniform(0.0f, 2.0f)},
            Pose{});
        if (crowd) {
            world.add(entity, CrowdPose{});
        }
    }
    world.run(prepare_crowd_clips);
    world.run(update_poses);
}

}  // namespace

void add_world_rows(CharacterBench& bench) {
    World crowd;
    World plain;
    fill_world(crowd, true);
    fill_world(plain, false);
    const int before = thread_count();
    constexpr double kNs = 1e9 / (kCount * kJoints);
    const auto run_crowd = [&] { crowd.run(update_poses); };
    set_thread_count(1);
    const auto [ours, exact] =
        race(thread_seconds, bench.repeats, run_crowd, [&] { plain.run(update_poses); });
    bench.add(
        {.gate = "",
         .name = "update_poses of 2000 with crowd_pose, per joint",
         .ours = ours * kNs,
         .reference = exact * kNs,
         .against = "without crowd_pose"});
    const double one = race(wall_seconds, bench.repeats, run_crowd)[0];
    set_thread_count(2);
    const double two = race(wall_seconds, bench.repeats, run_crowd)[0];
    bench.add(
        {.gate = "",
         .name = "the same: one thread over two",
         .ours = one * kNs,
         .reference = two * kNs,
         .against = "two threads",
         .at_least = true});
    set_thread_count(before);
}

}  // namespace limn::bench
