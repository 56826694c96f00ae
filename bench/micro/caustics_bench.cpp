#include "ecs/components/caustics.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/post.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/world.h"
#include "render/gpu/context.h"
#include "render/gpu/device.h"
#include "render/graph/frame_graph.h"
#include "render/render_frame.h"
#include "systems/water/water_wave_table.h"

#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

// Caustics against map size: a pool of 12 m by 9 m under eleven waves, with maps of 64 .. 1024
// texels per side, of transmitted and of reflected light; against the number of pools, with maps of
// 64; and against the cascades of unbounded water. Times are of the caustics passes of one frame
// only.

namespace {

using namespace limn;

struct Gpu {
    std::unique_ptr<gpu::Context> context;
    std::unique_ptr<gpu::Device> device;
    RendererPtr renderer;
};

template <typename T>
T value_or_stop(Result<T> made) {
    if (!made) {
        std::fprintf(stderr, "%s\n", made.error().message.c_str());
        std::exit(1);
    }
    return *std::move(made);
}

Gpu& shared_gpu() {
    static Gpu gpu = [] {
        Gpu made;
        made.context = value_or_stop(gpu::create_headless_context({}));
        made.device = value_or_stop(gpu::Device::from_current_context());
        made.renderer = value_or_stop(create_renderer(*made.device, {}));
        return made;
    }();
    return gpu;
}

/// A sun over water.
struct Scene {
    World world;
    Vec3 eye = {0, -0.5f, 0};  ///< looks down

    Scene() {
        world.insert_resource(Assets{});
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 1});
        world.insert_resource(Exposure{});
        const auto sun = glm::angleAxis(radians(-50), Vec3(1, 0, 0));
        world.create(DirectionalLight{}, WorldTransform{affine_from({0, 0, 0}, sun, Vec3(1))});
    }
    void fill(const Vec2& size, const Vec3& position, const Caustics& caustics) {
        const Water water = {.size = size, .depth = 1.6f};
        const WaterWaves waves = {
            .groups = {
                {.count = 5, .length = {1.6f, 3.6f}, .amplitude = {0.002f, 0.006f}},
                {.count = 6, .length = {0.5f, 1.2f}, .amplitude = {0.0006f, 0.0016f}}}};
        WaveTable table;
        fill_wave_table(water, waves, 1.0, table);
        world.create(
            water, WorldTransform{affine_from(position, {1, 0, 0, 0}, Vec3(1))}, caustics, table);
    }
    /// Renders a frame and returns the time of the caustics passes [s].
    double draw() {
        const Affine pose = affine_from(eye, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), Vec3(1));
        const RenderView view = make_render_view({}, pose, pose, {.width = 64, .height = 36});
        (void)render_frame(*shared_gpu().renderer, world, view);
        glFinish();
        double ms = 0;
        for (const PassTiming& pass : frame_graph(*shared_gpu().renderer).timings()) {
            if (pass.name.starts_with("caustic")) {
                ms += pass.last_gpu_ms;
            }
        }
        return ms * 1e-3;
    }
};

void measure(benchmark::State& state, Scene& scene) {
    for (int i = 0; i < 6; ++i) {
        (void)scene.draw();  // GPU timings arrive a few frames late
    }
    for (auto _ : state) {
        state.SetIterationTime(scene.draw());
    }
}

void below(benchmark::State& state) {
    Scene scene;
    scene.fill({12, 9}, {0, 0, 0}, {.resolution = static_cast<std::int32_t>(state.range(0))});
    measure(state, scene);
}
void mirrored(benchmark::State& state) {
    Scene scene;
    scene.fill(
        {12, 9}, {0, 0, 0},
        {.resolution = 64,
         .mirror_reach = 4,
         .mirror_resolution = static_cast<std::int32_t>(state.range(0))});
    measure(state, scene);
}
void cascades(benchmark::State& state) {
    Scene scene;
    scene.fill(
        {0, 0}, {0, 0, 0},
        {.resolution = 256, .cascades = static_cast<std::int32_t>(state.range(0))});
    measure(state, scene);
}
void pools(benchmark::State& state) {
    Scene scene;
    scene.eye = {14, 45, 14};  // all pools in view
    for (int i = 0; i < state.range(0); ++i) {
        const Vec3 position(static_cast<float>(3 * (i % 10)), 0, static_cast<float>(3 * (i / 10)));
        scene.fill({2, 2}, position, {.resolution = 64});
    }
    measure(state, scene);
    state.counters["ms_per_pool"] = benchmark::Counter(
        static_cast<double>(state.range(0)) * 1e-3,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace

BENCHMARK(below)->RangeMultiplier(2)->Range(64, 1024)->UseManualTime()->Unit(
    benchmark::kMillisecond);
BENCHMARK(mirrored)->RangeMultiplier(2)->Range(64, 512)->UseManualTime()->Unit(
    benchmark::kMillisecond);
BENCHMARK(cascades)->DenseRange(1, 3)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(pools)->Arg(1)->Arg(10)->Arg(30)->Arg(100)->UseManualTime()->Unit(
    benchmark::kMillisecond);
