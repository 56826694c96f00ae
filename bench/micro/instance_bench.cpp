// Reading the world, culling and filling the instance buffer, the renderer's CPU work per frame:
// 100,000 boxes of one mesh that move or are at rest; `visible` is the number in view.

#include "ecs/base/jobs.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/geometry/instance_list.h"
#include "render/geometry/mesh_pool.h"
#include "render/gpu/context.h"
#include "render/gpu/device.h"
#include "render/skinning/deformed_list.h"

#include <benchmark/benchmark.h>

#include <memory>

namespace limn {
namespace {

constexpr int kBoxes = 100000;

struct Crowd {
    Crowd()
        : context(*gpu::create_headless_context()), device(*gpu::Device::from_current_context()),
          materials(std::make_unique<MaterialPool>(*device, 1.0f)),
          meshes(std::make_unique<MeshPool>()),
          ring(std::make_unique<gpu::RingBuffer>(device->caps(), "bench", std::size_t{64} << 20)) {
        Assets assets;
        MeshData box;
        box.positions = {{-1, -1, -1}, {1, -1, -1}, {0, 1, 1}};
        box.normals.assign(3, {0, 0, 1});
        box.indices = {0, 1, 2};
        assets.meshes.push_back(box);
        assets.materials.resize(8);
        meshes->update(assets.meshes);
        materials->update(assets, true);
        for (int i = 0; i < kBoxes; ++i) {
            const Vec3 position = {i % 317 - 158, i / 317 - 158, 0};
            const Affine now = affine_from(position, {1, 0, 0, 0}, Vec3(0.3f));
            world.create(
                MeshInstance{{0}, {static_cast<std::uint32_t>(i) % 8}}, WorldTransform{now},
                PreviousWorldTransform{now});
        }
    }

    std::unique_ptr<gpu::Context> context;
    std::unique_ptr<gpu::Device> device;
    std::unique_ptr<MaterialPool> materials;
    std::unique_ptr<MeshPool> meshes;
    std::unique_ptr<gpu::RingBuffer> ring;
    World world;
};

void collect_100k(benchmark::State& state) {
    static Crowd crowd;
    set_thread_count(static_cast<int>(state.range(0)));
    // From far away all are in view, from the center a tenth.
    const float distance = state.range(1) == 100 ? 400.0f : 55.0f;
    const Affine eye = look_at({0, 0, distance}, {0, 0, 0});
    const RenderView view = make_render_view({}, eye, eye);
    const bool moving = state.range(2) != 0;
    InstanceCollector collector;
    RenderItems items;
    InstanceList list;
    DeformedList shapes(1 << 27);
    for (auto _ : state) {
        if (moving) {
            state.PauseTiming();
            crowd.world.query<WorldTransform>().each([](WorldTransform&) {});
            state.ResumeTiming();
        }
        crowd.ring->begin_frame();
        items.update(crowd.world, *crowd.meshes, *crowd.materials, shapes, 1);
        collector.collect(items, view, false, *crowd.ring, list);
        crowd.ring->end_frame();
    }
    state.counters["visible"] = list.visible;
    state.SetItemsProcessed(state.iterations() * kBoxes);
}
BENCHMARK(collect_100k)
    ->ArgNames({"threads", "visible_percent", "moving"})
    ->ArgsProduct({{1, 2}, {10, 100}, {0, 1}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace limn
