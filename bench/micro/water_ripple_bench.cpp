#include "ecs/base/jobs.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_kernels.h"
#include "systems/water/water_ripple_system.h"
#include "systems/water/water_ripple_walls.h"

#include <benchmark/benchmark.h>

#include <cstring>
#include <vector>

// Ripples against the size of their grid: a sub-step of the wave equation, SIMD and scalar, a copy
// of as many bytes as it moves (reads two fields, writes one), and a whole step on one and two
// threads. The same around 64 columns of ten cells, and the cost of moving one of them. Then one to
// a hundred pools of different sizes in a world.

namespace {

using namespace limn;

constexpr float kStep = 1.0f / 60;

RippleState make_pool(benchmark::State& state) {
    const auto side = static_cast<float>(state.range(0));
    RippleState pool = make_ripples({.size = {0.05f * side, 0.05f * side}}, {.cell = 0.05f}, kStep);
    push_ripples(pool, {.radius = 1, .height = 0.1f});
    return pool;
}

void per_cell(benchmark::State& state) {
    state.counters["per_cell"] = benchmark::Counter(
        static_cast<double>(state.range(0) * state.range(0)),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
}

template <auto step_row>
void substep(benchmark::State& state) {
    RippleState pool = make_pool(state);
    const auto width = static_cast<std::size_t>(pool.cells.x);
    const std::vector<float> keep(width, 0.999f);
    for (auto _ : state) {
        for (int z = 0; z < pool.cells.y; ++z) {
            const float* const h = pool.height.data();
            step_row(
                {h + pool.at(0, z - 1), h + pool.at(0, z), h + pool.at(0, z + 1)},
                {pool.previous.data() + pool.at(0, z), width}, keep.data(), 1.0f, 0.3f);
        }
        std::swap(pool.height, pool.previous);
        benchmark::ClobberMemory();
    }
    per_cell(state);
}

/// 12 bytes of memory traffic per cell, as in a sub-step: here 6 are read and 6 written.
void raw_copy(benchmark::State& state) {
    const auto cells = static_cast<std::size_t>(state.range(0) * state.range(0));
    std::vector<float> from(cells * 3 / 2, 1.0f);
    std::vector<float> to(cells * 3 / 2);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), to.size() * sizeof(float));
        benchmark::ClobberMemory();
    }
    per_cell(state);
}

void step(benchmark::State& state) {
    set_thread_count(static_cast<int>(state.range(1)));
    RippleState pool = make_pool(state);
    const WaterRipples ripples = {.cell = 0.05f};
    for (auto _ : state) {
        step_ripples(pool, ripples, kStep);
    }
    per_cell(state);
}

/// Eight by eight columns, each a fortieth of the pool thick; the first is displaced.
std::vector<PlacedWall> columns_of(const RippleState& pool, float aside) {
    std::vector<PlacedWall> columns;
    const float side = pool.size().x;
    for (int i = 0; i < 64; ++i) {
        const Vec2 center = side * ((Vec2(i % 8, i / 8) + 0.5f) / 8.0f - 0.5f);
        const Affine world = affine_from(
            {center.x + (i == 0 ? aside : 0.0f), 0, center.y}, Quat(1, 0, 0, 0), Vec3(1));
        const float radius = side / 80;
        columns.push_back(*place_wall(
            {.shape = WallShape::Cylinder, .half = {radius, 1, radius}}, world, {}, 1,
            pool.size()));
    }
    return columns;
}

void step_columns(benchmark::State& state) {
    set_thread_count(static_cast<int>(state.range(1)));
    RippleState pool = make_pool(state);
    set_ripple_walls(pool, columns_of(pool, 0), RippleBorder::Reflecting);
    const WaterRipples ripples = {.cell = 0.05f};
    for (auto _ : state) {
        step_ripples(pool, ripples, kStep);
    }
    per_cell(state);
}

void move_column(benchmark::State& state) {
    RippleState pool = make_pool(state);
    const std::vector<PlacedWall> walls[2] = {columns_of(pool, 0), columns_of(pool, 0.2f)};
    int turn = 0;
    for (auto _ : state) {
        set_ripple_walls(pool, walls[turn++ % 2], RippleBorder::Reflecting);
    }
    per_cell(state);
}

/// Pools of 32 to 128 cells per side in a world, with rain.
void many_pools(benchmark::State& state) {
    set_thread_count(1);
    World world;
    world.insert_resource(FrameTime{});
    world.insert_resource(RandomSeed{});
    world.insert_resource(Assets{});
    std::int64_t cells = 0;
    for (std::int64_t i = 0; i < state.range(0); ++i) {
        const int side = 32 + static_cast<int>(i * 37 % 97);
        const float size = 0.05f * static_cast<float>(side);
        const Vec3 position = {10.0f * static_cast<float>(i), 0, 0};
        world.create(
            Transform{.position = position},
            WorldTransform{affine_from(position, Quat(1, 0, 0, 0), Vec3(1))},
            Water{.size = Vec2(size)}, WaterRipples{.rain = 10});
        cells += side * side;
    }
    world.run(add_ripple_states);
    for (auto _ : state) {
        world.run(update_water_ripples);
    }
    state.counters["cells"] = static_cast<double>(cells);
    state.counters["per_cell"] = benchmark::Counter(
        static_cast<double>(cells),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
}

void each_size(benchmark::internal::Benchmark* bench) {
    for (const int size : {64, 128, 256, 512, 1024}) {
        bench->Arg(size);
    }
}

BENCHMARK(substep<step_ripple_row>)->Name("ripple_substep")->Apply(each_size);
BENCHMARK(substep<step_ripple_row_scalar>)->Name("ripple_substep_scalar")->Apply(each_size);
BENCHMARK(raw_copy)->Name("ripple_raw_copy")->Apply(each_size);
BENCHMARK(step)
    ->Name("ripple_step")
    ->ArgsProduct({{64, 128, 256, 512, 1024}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(step_columns)
    ->Name("ripple_step_columns")
    ->ArgsProduct({{64, 128, 256, 512, 1024}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(move_column)->Name("ripple_move_column")->Apply(each_size)->Unit(benchmark::kMillisecond);
BENCHMARK(many_pools)
    ->Name("ripple_pools")
    ->Arg(1)
    ->Arg(3)
    ->Arg(10)
    ->Arg(30)
    ->Arg(100)
    ->Unit(benchmark::kMillisecond);

}  // namespace
