#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "ecs/components/animation.h"
#include "ecs/components/time.h"
#include "ecs/world.h"
#include "systems/animation/clip_player_system.h"
#include "systems/animation/pose_system.h"
#include "systems/animation/skin_kernels.h"

#include <benchmark/benchmark.h>

#include <cstring>
#include <vector>

// Skinning 1,000,000 vertices of four influences on the CPU, SIMD and scalar, compared with a raw
// copy of the bytes that it reads and writes; and the poses of 1,000 characters of 24 joints. Most
// neighboring vertices share their joints, as in a mesh with grouped vertices; `_mixed`: none do;
// `_cached`: like the first, but with few enough vertices to stay in the cache.

namespace {

using namespace limn;

constexpr std::size_t kVertices = 1000000;  // more than any cache holds
constexpr std::size_t kCached = 4000;
constexpr std::size_t kJoints = 24;
constexpr std::size_t kCharacters = 1000;

struct Crowd {
    SkinWeights skin;
    std::vector<Affine> palette{kJoints};
    std::vector<DualQuaternion> duals{kJoints};
    std::vector<Vec3> positions{kVertices};
    std::vector<Vec3> normals{kVertices};
    std::vector<Vec4> tangents{kVertices};
    std::vector<Vec3> moved_positions{kVertices};
    std::vector<Vec3> moved_normals{kVertices};
    std::vector<Vec4> moved_tangents{kVertices};

    explicit Crowd(bool mixed = false) {
        Random random(1, 0, name_hash("crowd"), 0);
        for (Affine& m : palette) {
            m = affine_from(random.direction(), rotation_about(random.direction(), 0.5f), Vec3(1));
        }
        compute_dual_palette(palette, duals);
        skin.first.push_back(0);
        for (std::size_t v = 0; v < kVertices; ++v) {
            positions[v] = random.direction();
            normals[v] = random.direction();
            tangents[v] = Vec4(any_perpendicular(normals[v]), 1.0f);
            const std::size_t first = mixed ? v * 7 % (kJoints - 4) : v * (kJoints - 4) / kVertices;
            for (std::size_t i = 0; i < 4; ++i) {
                skin.joints.push_back(static_cast<std::uint16_t>(first + i));
                skin.weights.push_back(0.25f);
            }
            skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
        }
    }
    [[nodiscard]] RestVertices rest() const { return {positions, normals, tangents}; }
    SkinnedVertices moved() { return {moved_positions, moved_normals, moved_tangents}; }
    /// Read and written [bytes]; the palette stays in the cache.
    [[nodiscard]] std::size_t bytes() const {
        return kVertices * (2 * (sizeof(Vec3) + sizeof(Vec3) + sizeof(Vec4)) + sizeof(float))
               + skin.weights.size() * (sizeof(float) + sizeof(std::uint16_t));
    }
};

void per_vertex(benchmark::State& state, std::size_t bytes) {
    state.counters["ns_per_vertex"] = benchmark::Counter(
        static_cast<double>(kVertices),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
    state.counters["GB_per_s"] = benchmark::Counter(
        static_cast<double>(bytes) * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
}

/// Copies half as many bytes as skinning reads and writes in total. In pieces: a large memcpy would
/// use non-temporal stores, which is wrong for data that is read again at once.
void raw_copy(benchmark::State& state) {
    constexpr std::size_t kPiece = 16384;
    const std::size_t pieces = Crowd().bytes() / 2 / kPiece;
    std::vector<char> from(pieces * kPiece, 1);
    std::vector<char> to(pieces * kPiece, 0);
    for (auto _ : state) {
        for (std::size_t i = 0; i < pieces; ++i) {
            std::memcpy(to.data() + i * kPiece, from.data() + i * kPiece, kPiece);
        }
        benchmark::ClobberMemory();
    }
    per_vertex(state, 2 * pieces * kPiece);
}

/// Skins kVertices vertices in total, repeating the first kPiece.
template <auto kernel, bool kDual, bool kMixed, std::size_t kPiece>
void skin_vertices(benchmark::State& state) {
    Crowd crowd(kMixed);
    for (auto _ : state) {
        for (std::size_t done = 0; done < kVertices; done += kPiece) {
            if constexpr (kDual) {
                kernel(crowd.skin, crowd.duals, crowd.rest(), crowd.moved(), 0, kPiece);
            } else {
                kernel(crowd.skin, crowd.palette, crowd.rest(), crowd.moved(), 0, kPiece);
            }
        }
        benchmark::ClobberMemory();
    }
    per_vertex(state, crowd.bytes());
}

/// A skeleton with a clip of 60 keys that rotates and moves every joint.
Assets make_assets() {
    Assets assets;
    SkeletonData& skeleton = assets.skeletons.emplace_back();
    ClipData& clip = assets.clips.emplace_back();
    clip.duration = 2.0f;
    ClipSheet& sheet = clip.sheets.emplace_back();
    for (std::size_t i = 0; i < kJoints; ++i) {
        skeleton.joints.emplace_back("joint");
        skeleton.parents.push_back(static_cast<std::int32_t>(i) - 1);
        skeleton.rest.translations.emplace_back(0, 1, 0);
        skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
        skeleton.rest.scales.emplace_back(1);
        sheet.rotating.push_back(static_cast<std::uint16_t>(i));
        sheet.translating.push_back(static_cast<std::uint16_t>(i));
    }
    Random random(2, 0, name_hash("clip"), 0);
    for (std::size_t key = 0; key < 60; ++key) {
        sheet.times.push_back(2.0f * static_cast<float>(key) / 59.0f);
        for (std::size_t i = 0; i < kJoints; ++i) {
            sheet.rotations.push_back(rotation_about(random.direction(), 0.5f));
            sheet.translations.push_back(random.direction());
        }
    }
    return assets;
}

void update_crowd(benchmark::State& state) {
    set_thread_count(static_cast<int>(state.range(0)));
    World world;
    world.insert_resource(make_assets());
    world.insert_resource(FrameTime{});
    for (std::size_t i = 0; i < kCharacters; ++i) {
        world.create(
            Skeleton{{0}}, ClipPlayer{.clip = {0}, .time = 0.002f * static_cast<float>(i)}, Pose{});
    }
    for (auto _ : state) {
        world.run(advance_clips);
        world.run(update_poses);
    }
    state.counters["us_per_character"] = benchmark::Counter(
        static_cast<double>(kCharacters) * 1e-6,
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace

BENCHMARK(raw_copy)->UseRealTime();
BENCHMARK(skin_vertices<skin_linear, false, false, kVertices>)->Name("skin_linear")->UseRealTime();
BENCHMARK(skin_vertices<skin_linear, false, true, kVertices>)
    ->Name("skin_linear_mixed")
    ->UseRealTime();
BENCHMARK(skin_vertices<skin_linear, false, false, kCached>)
    ->Name("skin_linear_cached")
    ->UseRealTime();
BENCHMARK(skin_vertices<skin_linear_scalar, false, false, kVertices>)
    ->Name("skin_linear_scalar")
    ->UseRealTime();
BENCHMARK(skin_vertices<skin_linear_scalar, false, false, kCached>)
    ->Name("skin_linear_scalar_cached")
    ->UseRealTime();
BENCHMARK(skin_vertices<skin_dual, true, false, kVertices>)->Name("skin_dual")->UseRealTime();
BENCHMARK(skin_vertices<skin_dual, true, true, kVertices>)->Name("skin_dual_mixed")->UseRealTime();
BENCHMARK(skin_vertices<skin_dual_scalar, true, false, kVertices>)
    ->Name("skin_dual_scalar")
    ->UseRealTime();
BENCHMARK(update_crowd)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
