#include "ecs/components/all.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/prefab.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"

#include <benchmark/benchmark.h>

#include <utility>

namespace {

using namespace limn;

template <std::size_t number>
struct Number {
    int value = 0;
};

template <std::size_t number>
void idle(Query<Number<number>> numbers) {
    benchmark::DoNotOptimize(numbers);
}

/// An idle frame: the overhead of 100 systems.
void BM_IdleSchedule(benchmark::State& state) {
    World world;
    Schedule schedule;
    [&]<std::size_t... numbers>(std::index_sequence<numbers...>) {
        (schedule.add<idle<numbers>>(), ...);
    }
    (std::make_index_sequence<100>{});
    for (auto _ : state) {
        schedule.run(world);
    }
}
BENCHMARK(BM_IdleSchedule)->Unit(benchmark::kMicrosecond);

void fill(World& world, std::size_t count) {
    register_all_components();
    world.create_many(count, Transform{}, WorldTransform{}, PreviousWorldTransform{}, Spin{});
}

/// Per entity 152 bytes of components and 8 of the handle.
void BM_StateHash(benchmark::State& state) {
    World world;
    fill(world, static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(state_hash(world));
    }
    state.SetBytesProcessed(state.iterations() * state.range(0) * 160);
}
BENCHMARK(BM_StateHash)->Arg(100'000)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_SaveSnapshot(benchmark::State& state) {
    World world;
    fill(world, 100'000);
    for (auto _ : state) {
        benchmark::DoNotOptimize(save_snapshot(world));
    }
}
BENCHMARK(BM_SaveSnapshot)->Unit(benchmark::kMillisecond);

void BM_RestoreSnapshot(benchmark::State& state) {
    World world;
    fill(world, 100'000);
    const std::vector<std::byte> bytes = save_snapshot(world).value();
    for (auto _ : state) {
        benchmark::DoNotOptimize(restore_snapshot(world, bytes).ok());
    }
}
BENCHMARK(BM_RestoreSnapshot)->Unit(benchmark::kMillisecond);

/// 10,000 trees of ten entities: access without changes (0), and a rebuild (1).
void BM_Hierarchy(benchmark::State& state) {
    World world;
    Entity first;
    for (int tree = 0; tree < 10'000; ++tree) {
        const Entity root = world.create(Transform{});
        for (int i = 0; i < 9; ++i) {
            first = world.create(Transform{}, Parent{root});
        }
    }
    const bool rebuild = state.range(0) != 0;
    for (auto _ : state) {
        if (rebuild) {
            world.get<Parent>(first).order ^= 1;
        }
        benchmark::DoNotOptimize(hierarchy(world).nodes().data());
    }
}
BENCHMARK(BM_Hierarchy)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void BM_SpawnPrefab(benchmark::State& state) {
    World world;
    const Entity root = world.create(Transform{}, WorldTransform{}, Spin{});
    for (int i = 0; i < 4; ++i) {
        world.create(Transform{}, WorldTransform{}, Parent{root});
    }
    const Prefab prefab = make_prefab(world, root);
    for (auto _ : state) {
        benchmark::DoNotOptimize(spawn(world, prefab, 10'000));
        state.PauseTiming();
        world.clear();
        state.ResumeTiming();
    }
    state.SetItemsProcessed(state.iterations() * 50'000);
}
BENCHMARK(BM_SpawnPrefab)->Unit(benchmark::kMillisecond);

}  // namespace
