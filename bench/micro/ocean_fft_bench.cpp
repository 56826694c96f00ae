#include "render/gpu/context.h"
#include "render/gpu/device.h"
#include "render/water/ocean_fft.h"
#include "systems/water/ocean_system.h"

#include <benchmark/benchmark.h>

#include <memory>

// The ocean's FFTs on the GPU against their size: all fields of three cascades for a new time,
// including the wait for the GPU. For the CPU version see water_bench.

namespace {

using namespace limn;

struct Screen {
    std::unique_ptr<gpu::Context> context;
    std::unique_ptr<gpu::Device> device;
};

/// Empty where there is no OpenGL.
const Screen& shared_screen() {
    static const Screen screen = [] {
        Screen made;
        if (Result<std::unique_ptr<gpu::Context>> context = gpu::create_headless_context({})) {
            made.context = *std::move(context);
            if (Result<std::unique_ptr<gpu::Device>> device = gpu::Device::from_current_context()) {
                made.device = *std::move(device);
            }
        }
        return made;
    }();
    return screen;
}

void synthesize(benchmark::State& state) {
    if (shared_screen().device == nullptr) {
        state.SkipWithError("no OpenGL 4.5");
        return;
    }
    gpu::Device& device = *shared_screen().device;
    OceanState water;
    step_ocean({.resolution = static_cast<int>(state.range(0))}, 0.0, 1.0f / 60.0f, water);
    const Result<OceanFft> fft = create_ocean_fft(device, water);
    if (!fft) {
        state.SkipWithError(fft.error().message.c_str());
        return;
    }
    FrameGraph graph(device);
    double time = 0;
    const auto step = [&] {
        time += 1.0 / 60.0;
        graph.begin_frame();
        graph.keep(synthesize_ocean(graph, *fft, 1.0f, time).displacement);
        graph.execute();
        glFinish();
    };
    step();  // drivers compile a program at its first use
    for (auto _ : state) {
        step();
    }
    state.SetLabel(device.caps().renderer);
    state.counters["per_point"] = benchmark::Counter(
        3.0 * static_cast<double>(state.range(0) * state.range(0)),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
}

}  // namespace

BENCHMARK(synthesize)
    ->Name("ocean_fft")
    ->RangeMultiplier(2)
    ->Range(64, 1024)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
