#include "content/bake/furrow_height.h"
#include "content/bake/furrow_map.h"
#include "content/bake/furrow_trace.h"
#include "content/make/models/shapes.h"

#include <benchmark/benchmark.h>

#include <vector>

// Furrows on an image of 512 x 512: all that the editor does at once, and its parts. The argument
// is the magnitude of both fields in hundredths.

namespace limn {
namespace {

FurrowMap make_map(float magnitude) {
    const MeshData plane = make_plane({.divisions = 32});
    const FurrowArrow arrow = {
        .at = {0, 0, 0}, .first = {0.3f, 0, 1}, .second = {1, 0, -0.5f}, .weight = 1};
    auto edits = place_furrow_arrows({&arrow, 1}, plane.positions, plane.normals);
    for (Vec3& v : edits[0].vectors) {
        v = magnitude * glm::normalize(v);
    }
    const auto field = make_furrow_field(plane.positions, plane.normals, edits);
    return *make_furrow_map(plane, field, {.tiles = true});
}

float magnitude_of(const benchmark::State& state) {
    return static_cast<float>(state.range(0)) / 100.0f;
}

void generate(benchmark::State& state) {
    const FurrowMap map = make_map(magnitude_of(state));
    const FurrowStyle style = {.noise = 0.3f};
    for (auto _ : state) {
        const FurrowGrowth growth = grow_furrows(map, style);
        benchmark::DoNotOptimize(
            make_furrow_normals(map, growth, add_furrow_noise(growth, style), style.bump));
    }
}
BENCHMARK(generate)->Arg(30)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond)->UseRealTime();

void trace_one_field(benchmark::State& state) {
    const FurrowMap map = make_map(magnitude_of(state));
    const auto cover = cover_furrow_map(map);
    std::vector<FurrowSegment> segments;
    benchmark::DoNotOptimize(trace_furrows(map, cover, {}, 0, &segments));
    state.counters["segments"] = static_cast<double>(segments.size());
    for (auto _ : state) {
        benchmark::DoNotOptimize(trace_furrows(map, cover, {}, 0));
    }
}
BENCHMARK(trace_one_field)->Arg(30)->Arg(100)->Arg(200)->Unit(benchmark::kMillisecond);

void cover_map(benchmark::State& state) {
    const FurrowMap map = make_map(1);
    for (auto _ : state) {
        benchmark::DoNotOptimize(cover_furrow_map(map));
    }
}
BENCHMARK(cover_map)->Unit(benchmark::kMillisecond);

void remake(benchmark::State& state) {
    const FurrowMap map = make_map(1);
    const FurrowStyle style = {.noise = 0.3f};
    const FurrowGrowth growth = grow_furrows(map, style);
    for (auto _ : state) {
        benchmark::DoNotOptimize(
            make_furrow_normals(map, growth, add_furrow_noise(growth, style), style.bump));
    }
}
BENCHMARK(remake)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace limn
