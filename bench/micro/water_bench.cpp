#include "ecs/base/jobs.h"
#include "ecs/components/ocean.h"
#include "systems/water/fft_kernels.h"
#include "systems/water/ocean_cascades.h"
#include "systems/water/ocean_kernels.h"
#include "systems/water/ocean_system.h"

#include <benchmark/benchmark.h>
#include <kissfft/kiss_fftnd.h>

#include <complex>
#include <cstring>
#include <vector>

// The ocean against its resolution: one complex FFT compared with KissFFT's, its kernels SIMD and
// scalar, a copy of as many bytes as a step writes, and whole steps of one and three cascades.

namespace {

using namespace limn;

std::size_t size_of(const benchmark::State& state) {
    return static_cast<std::size_t>(state.range(0));
}

void per_point(benchmark::State& state, std::size_t points) {
    state.counters["per_point"] = benchmark::Counter(
        static_cast<double>(points),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
}

struct Spectrum {
    std::vector<float> re;
    std::vector<float> im;

    explicit Spectrum(std::size_t size) : re(size * size), im(size * size) {
        for (std::size_t i = 0; i < re.size(); ++i) {
            re[i] = static_cast<float>(i % 17) - 8.0f;
            im[i] = static_cast<float>(i % 5) - 2.0f;
        }
    }
};

void fft_2d(benchmark::State& state) {
    set_thread_count(static_cast<int>(state.range(1)));
    const std::size_t size = size_of(state);
    const FftPlan plan = make_fft_plan(size);
    const Spectrum spectrum(size);
    Spectrum field(size);
    for (auto _ : state) {
        inverse_fft_2d(plan, spectrum.re, spectrum.im, field.re, field.im);
        benchmark::ClobberMemory();
    }
    per_point(state, size * size);
}

void kissfft_2d(benchmark::State& state) {
    const int sizes[] = {static_cast<int>(state.range(0)), static_cast<int>(state.range(0))};
    kiss_fftnd_cfg plan = kiss_fftnd_alloc(sizes, 2, 1, nullptr, nullptr);
    std::vector<kiss_fft_cpx> spectrum(size_of(state) * size_of(state), {1, 1});
    std::vector<kiss_fft_cpx> field(spectrum.size());
    for (auto _ : state) {
        kiss_fftnd(plan, spectrum.data(), field.data());
        benchmark::ClobberMemory();
    }
    kiss_fft_free(plan);
    per_point(state, spectrum.size());
}

/// A block of columns that fits in the cache.
template <auto kernel>
void fft_columns(benchmark::State& state) {
    const std::size_t size = size_of(state);
    const FftPlan plan = make_fft_plan(size);
    std::vector<float> from(2 * kFftColumns * size, 0.1f);
    std::vector<float> to(from.size());
    std::vector<float> scratch(fft_scratch_size(size));
    for (auto _ : state) {
        kernel(
            plan, {from.data(), from.data() + from.size() / 2},
            {to.data(), to.data() + to.size() / 2}, scratch);
        benchmark::ClobberMemory();
    }
    per_point(state, kFftColumns * size);
}

OceanCascade make_cascade(std::size_t size) {
    return make_ocean_cascades({.cascades = 1, .resolution = static_cast<int>(size)}).front();
}

template <auto kernel>
void evolve(benchmark::State& state) {
    const std::size_t size = size_of(state);
    const OceanCascade cascade = make_cascade(size);
    std::vector<float> pairs(kOceanPairs * 2 * kFftColumns * size);
    double time = 0;
    for (auto _ : state) {
        for (std::size_t first = 0; first < size; first += kFftColumns) {
            kernel(cascade, 1.0f, time, first, pairs);
        }
        time += 1.0 / 60.0;
        benchmark::ClobberMemory();
    }
    per_point(state, size * size);
}

template <auto kernel>
void foam(benchmark::State& state) {
    OceanCascade cascade = make_cascade(size_of(state));
    synthesize_waves(cascade, 1.0f, 1.0);
    std::vector<float> coverage(cascade.height.size());
    for (auto _ : state) {
        kernel(
            {cascade.shift_xx, cascade.shift_zz, cascade.shift_xz}, 0.75f, 0.1f, 0.99f, coverage, 0,
            coverage.size());
        benchmark::ClobberMemory();
    }
    per_point(state, coverage.size());
}

/// The eight planes of a cascade.
void raw_copy(benchmark::State& state) {
    const std::size_t bytes = 8 * size_of(state) * size_of(state) * sizeof(float);
    std::vector<char> from(bytes, 1);
    std::vector<char> to(bytes);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), bytes);
        benchmark::ClobberMemory();
    }
    per_point(state, size_of(state) * size_of(state));
}

void step(benchmark::State& state) {
    const Ocean ocean = {
        .cascades = static_cast<int>(state.range(1)),
        .resolution = static_cast<int>(state.range(0))};
    set_thread_count(static_cast<int>(state.range(2)));
    OceanState water;
    OceanFoam foam;
    double time = 0;
    step_ocean(ocean, time, 1.0f / 60.0f, water);
    for (auto _ : state) {
        time += 1.0 / 60.0;
        step_ocean(ocean, time, 1.0f / 60.0f, water);
        step_ocean_foam(ocean, water, 1.0f / 60.0f, foam);
    }
    per_point(state, size_of(state) * size_of(state) * water.cascades.size());
}

void generate_spectra(benchmark::State& state) {
    set_thread_count(2);
    const Ocean ocean = {.resolution = static_cast<int>(state.range(0))};
    for (auto _ : state) {
        benchmark::DoNotOptimize(make_ocean_cascades(ocean));
    }
}

void each_size(benchmark::internal::Benchmark* bench) {
    bench->RangeMultiplier(2)->Range(64, 1024)->UseRealTime()->Unit(benchmark::kMicrosecond);
}

}  // namespace

BENCHMARK(fft_2d)
    ->ArgsProduct({{64, 128, 256, 512, 1024}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(kissfft_2d)->Apply(each_size);
BENCHMARK(fft_columns<inverse_fft_columns>)->Name("fft_columns")->Apply(each_size);
BENCHMARK(fft_columns<inverse_fft_columns_scalar>)->Name("fft_columns_scalar")->Apply(each_size);
BENCHMARK(evolve<evolve_waves>)->Name("evolve_waves")->Apply(each_size);
BENCHMARK(evolve<evolve_waves_scalar>)->Name("evolve_waves_scalar")->Apply(each_size);
BENCHMARK(foam<step_foam>)->Name("step_foam")->Apply(each_size);
BENCHMARK(foam<step_foam_scalar>)->Name("step_foam_scalar")->Apply(each_size);
BENCHMARK(raw_copy)->Apply(each_size);
BENCHMARK(step)
    ->ArgNames({"size", "cascades", "threads"})
    ->ArgsProduct({{64, 128, 256, 512, 1024}, {1, 3}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(generate_spectra)->Arg(64)->Arg(256)->UseRealTime()->Unit(benchmark::kMillisecond);
