#include "ecs/base/jobs.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_kernels.h"

#include <benchmark/benchmark.h>

#include <cstring>
#include <vector>

// Ripples against the size of their grid: a sub-step of the wave equation with vectors and with one
// lane, a copy of as many bytes as it moves (reads two fields, writes one), and a whole step on one
// and two threads.

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
                {pool.before.data() + pool.at(0, z), width},
                keep.data(),
                1.0f,
                0.3f);
        }
        std::swap(pool.height, pool.before);
        benchmark::ClobberMemory();
    }
    per_cell(state);
}

/// 12 bytes a cell go through memory, as in a sub-step: here 6 are read and 6 written.
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

}  // namespace
