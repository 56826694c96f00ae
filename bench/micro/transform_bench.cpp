#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/motion_kernels.h"
#include "systems/update_world.h"
#include "tests/systems/sway_table.h"

#include <benchmark/benchmark.h>

#include <cstring>
#include <vector>

// 100,000 boxes that spin and sway: each kernel SIMD and scalar, a raw copy of the bytes that the
// transform kernel moves (the memory bound), and the whole step through the ECS on 1 and 2 threads.

namespace {

using namespace limn;

constexpr std::size_t kBoxes = 100000;

struct Boxes {
    std::vector<Transform> transform{kBoxes};
    std::vector<WorldTransform> world{kBoxes};
    std::vector<PreviousWorldTransform> previous{kBoxes};
    std::vector<Spin> spin{kBoxes};
    std::vector<Sway> sway{kBoxes};

    Boxes() {
        Random random(1, 0, name_hash("boxes"), 0);
        for (std::size_t i = 0; i < kBoxes; ++i) {
            spin[i] = {.axis = random.direction(), .speed = random.uniform(-3, 3)};
            sway[i] = {.center = 50.0f * random.direction(), .phase = 3.0f * random.direction()};
        }
        compose_worlds(transform, world, previous);
    }
};

void per_box(benchmark::State& state) {
    state.counters["ns_per_box"] = benchmark::Counter(
        static_cast<double>(kBoxes),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
    state.counters["threads"] = static_cast<double>(thread_count());
}

/// previous = world, world = an array of the same size: the memory traffic of compose_worlds
/// without its arithmetic.
void raw_copy(benchmark::State& state) {
    Boxes boxes;
    std::vector<WorldTransform> source = boxes.world;
    for (auto _ : state) {
        std::memcpy(
            static_cast<void*>(boxes.previous.data()), boxes.world.data(),
            kBoxes * sizeof(WorldTransform));
        std::memcpy(
            static_cast<void*>(boxes.world.data()), source.data(), kBoxes * sizeof(WorldTransform));
        benchmark::ClobberMemory();
    }
    per_box(state);
}

void compose(benchmark::State& state) {
    Boxes boxes;
    const auto kernel = state.range(0) != 0 ? compose_worlds : compose_worlds_scalar;
    for (auto _ : state) {
        kernel(boxes.transform, boxes.world, boxes.previous);
        benchmark::ClobberMemory();
    }
    per_box(state);
}

void spin(benchmark::State& state) {
    Boxes boxes;
    const auto kernel = state.range(0) != 0 ? turn_rotations : turn_rotations_scalar;
    for (auto _ : state) {
        kernel(boxes.spin, 1.0f / 60.0f, boxes.transform);
        benchmark::ClobberMemory();
    }
    per_box(state);
}

void sway(benchmark::State& state) {
    Boxes boxes;
    const test::SwayTable table(boxes.sway);
    const auto kernel = state.range(0) != 0 ? sway_positions : sway_positions_scalar;
    double time = 0;
    for (auto _ : state) {
        kernel(table.arrays(), time += 1.0 / 60.0, boxes.transform);
        benchmark::ClobberMemory();
    }
    per_box(state);
}

void step(benchmark::State& state) {
    const int threads = thread_count();
    set_thread_count(static_cast<int>(state.range(0)));
    World world;
    Boxes boxes;
    for (std::size_t i = 0; i < kBoxes; ++i) {
        world.create(boxes.transform[i], boxes.spin[i], boxes.sway[i]);
    }
    Schedule schedule = make_world_schedule();
    step_world(world, schedule);
    for (auto _ : state) {
        step_world(world, schedule);
    }
    per_box(state);
    set_thread_count(threads);
}

/// The same with everything at rest.
void step_at_rest(benchmark::State& state) {
    World world;
    world.create_many(kBoxes, Transform{});
    Schedule schedule = make_world_schedule();
    for (int i = 0; i < 3; ++i) {
        step_world(world, schedule);
    }
    for (auto _ : state) {
        step_world(world, schedule);
    }
    per_box(state);
}

}  // namespace

BENCHMARK(raw_copy)->Unit(benchmark::kMicrosecond);
BENCHMARK(compose)->Arg(1)->Arg(0)->ArgName("simd")->Unit(benchmark::kMicrosecond);
BENCHMARK(spin)->Arg(1)->Arg(0)->ArgName("simd")->Unit(benchmark::kMicrosecond);
BENCHMARK(sway)->Arg(1)->Arg(0)->ArgName("simd")->Unit(benchmark::kMicrosecond);
BENCHMARK(step)->Arg(1)->Arg(2)->ArgName("threads")->UseRealTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(step_at_rest)->UseRealTime()->Unit(benchmark::kMicrosecond);
