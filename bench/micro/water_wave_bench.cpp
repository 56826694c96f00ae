#include "systems/water/water_wave_kernels.h"
#include "systems/water/water_wave_table.h"

#include <benchmark/benchmark.h>

#include <vector>

// Closed-form waves at the points of a square grid: 32 line waves, a quarter of them leaning, SIMD,
// scalar, and point by point with slopes and velocity as in the query.

namespace {

using namespace limn;

struct Grid {
    explicit Grid(std::int64_t side) {
        for (std::int64_t i = 0; i < side * side; ++i) {
            x.push_back(0.1f * static_cast<float>(i % side));
            z.push_back(0.1f * static_cast<float>(i / side));
        }
        for (std::vector<float>* const plane : {&offset_x, &height, &offset_z}) {
            plane->resize(x.size());
        }
        WaterWaves waves = {.groups = {{.count = 24, .length = {0.5f, 12}, .sharpness = 0.7f}}};
        for (int i = 0; i < 8; ++i) {
            const auto turn = static_cast<float>(i);
            waves.waves.push_back({.length = 3 + turn, .direction = turn, .lean = 0.4f});
        }
        fill_wave_table({}, waves, 12.5, table);
    }
    std::vector<float> x;
    std::vector<float> z;
    std::vector<float> offset_x;
    std::vector<float> height;
    std::vector<float> offset_z;
    WaveTable table;
};

void per_wave(benchmark::State& state, const Grid& grid) {
    state.counters["per_wave"] = benchmark::Counter(
        static_cast<double>(grid.x.size() * grid.table.lines.size()),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
}

template <auto sum>
void sum_grid(benchmark::State& state) {
    Grid grid(state.range(0));
    const WaveOffsets offsets = {grid.offset_x, grid.height, grid.offset_z};
    for (auto _ : state) {
        sum(grid.table.lines, grid.x, grid.z, offsets);
        benchmark::ClobberMemory();
    }
    per_wave(state, grid);
}

void evaluate_grid(benchmark::State& state) {
    const Grid grid(state.range(0));
    for (auto _ : state) {
        Vec3 sum(0);
        for (std::size_t i = 0; i < grid.x.size(); ++i) {
            sum += evaluate_waves(grid.table, {grid.x[i], grid.z[i]}).offset;
        }
        benchmark::DoNotOptimize(sum);
    }
    per_wave(state, grid);
}

void each_size(benchmark::internal::Benchmark* bench) {
    bench->Unit(benchmark::kMillisecond);
    for (const int size : {64, 128, 256, 512, 1024}) {
        bench->Arg(size);
    }
}

BENCHMARK(sum_grid<sum_waves>)->Name("sum_waves")->Apply(each_size);
BENCHMARK(sum_grid<sum_waves_scalar>)->Name("sum_waves_scalar")->Apply(each_size);
BENCHMARK(evaluate_grid)->Name("evaluate_waves")->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
