// Normal map of 1024 x 1024 texels from a mesh of 500,000 triangles, with four rays per texel, and
// the relief and cone maps of the same mesh.

#include "content/bake/cone_map.h"
#include "content/bake/detail_bake.h"
#include "content/bake/relief_bake.h"
#include "content/make/models/shapes.h"
#include "ecs/base/check.h"
#include "ecs/components/surface.h"

#include <benchmark/benchmark.h>

namespace limn {
namespace {

MeshData make_high() {
    return make_sphere({.radius = 1, .segments = 708, .rings = 354});
}

void bake_normals_of_500k_triangles(benchmark::State& state) {
    const MeshData low = make_sphere({.radius = 1, .segments = 24, .rings = 12});
    const MeshData high = make_high();
    const DetailSettings settings = {
        .width = 1024, .height = 1024, .samples = static_cast<int>(state.range(0))};
    for (auto _ : state) {
        const Result<DetailBake> bake = bake_detail(low, high, settings);
        LIMN_CHECK(bake.ok() && bake->report.missed == 0);
        benchmark::DoNotOptimize(bake->normal.texels.data());
    }
}
BENCHMARK(bake_normals_of_500k_triangles)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void bake_relief_of_500k_triangles(benchmark::State& state) {
    const MeshData high = make_high();
    for (auto _ : state) {
        const TileSurface tile = tile_of(high, BoxFace::Front, 0, true);
        const ReliefBake bake = bake_relief(tile, TileCaster(tile), ReliefLayout::Double, 1024, 1);
        benchmark::DoNotOptimize(bake.map.texels.data());
    }
}
BENCHMARK(bake_relief_of_500k_triangles)->Unit(benchmark::kMillisecond)->UseRealTime();

void bake_cones(benchmark::State& state) {
    const int size = static_cast<int>(state.range(0));
    const MeshData high = make_torus({});
    const TileSurface tile = tile_of(high, BoxFace::Top, 0, true);
    const ReliefBake relief = bake_relief(tile, TileCaster(tile), ReliefLayout::Single, size, 1);
    for (auto _ : state) {
        const BakedMap cones = make_cone_map(relief.map, true);
        benchmark::DoNotOptimize(cones.texels.data());
    }
}
BENCHMARK(bake_cones)->Arg(128)->Arg(256)->Arg(512)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace limn
