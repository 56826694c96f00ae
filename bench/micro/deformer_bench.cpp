#include "ecs/base/rng.h"
#include "ecs/components/deformers.h"
#include "systems/animation/deformer_kernels.h"
#include "systems/animation/patch_binding.h"
#include "systems/animation/patch_kernels.h"
#include "systems/animation/skin_kernels.h"
#include "systems/animation/surface_faces.h"
#include "systems/animation/surface_patches.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

// Deformers of a face of 10,000 vertices on the CPU, one thread: muscles and a lattice, a surface
// of 512 faces by patches and by faces, and the patches themselves.

namespace {

using namespace limn;

constexpr std::size_t kVertices = 10000;
constexpr int kCells = 16;  // of the surface, along an edge

struct Face {
    std::vector<Vec3> surface;
    std::vector<std::uint32_t> corners;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<Vec4> tangents;

    Face() {
        for (int y = 0; y <= kCells; ++y) {
            for (int x = 0; x <= kCells; ++x) {
                surface.push_back(on_face(Vec2(x, y) / static_cast<float>(kCells), 0));
            }
        }
        const auto at = [](int x, int y) {
            return static_cast<std::uint32_t>(y * (kCells + 1) + x);
        };
        for (int y = 0; y < kCells; ++y) {
            for (int x = 0; x < kCells; ++x) {
                for (const std::uint32_t v :
                     {at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y), at(x + 1, y + 1),
                      at(x, y + 1)}) {
                    corners.push_back(v);
                }
            }
        }
        for (std::size_t v = 0; v < kVertices; ++v) {
            const Vec2 fraction = (Vec2(v % 100, v / 100) + 0.5f) / 100.0f;
            positions.push_back(on_face(fraction, 0.004f));
            normals.emplace_back(0, 0, 1);
            tangents.emplace_back(1, 0, 0, 1);
        }
    }
    static Vec3 on_face(const Vec2& fraction, float above) {
        const Vec2 at = 0.16f * (fraction - 0.5f);
        return {at, 0.1f - 4 * glm::dot(at, at) + above};
    }
};

const Face& face() {
    static const Face made;
    return made;
}

void per_vertex(benchmark::State& state) {
    state.counters["ns_per_vertex"] = benchmark::Counter(
        static_cast<double>(kVertices),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
}

/// Four muscles, a ring around the mouth and a lattice around the nose.
void muscles_and_lattice(benchmark::State& state) {
    Deformers deformers;
    for (const float side : {-1.0f, 1.0f}) {
        for (const float height : {-0.03f, 0.05f}) {
            deformers.muscles.push_back(
                {.attachment = {0.05f * side, height + 0.03f, 0.07f},
                 .insertion = {0.02f * side, height, 0.1f},
                 .angle = 0.6f,
                 .full = 0.05f,
                 .reach = 0.08f,
                 .contraction = 0.2f});
        }
    }
    deformers.sphincters.push_back({.center = {0, -0.04f, 0.1f}, .contraction = 0.3f});
    deformers.lattices.push_back(
        {.origin = {-0.03f, -0.02f, 0.05f},
         .u = {0.06f, 0, 0},
         .v = {0, 0.06f, 0},
         .w = {0, 0, 0.08f},
         .offsets = std::vector<Vec3>(kLatticePoints, Vec3(0.001f))});
    const std::vector<Vec4> packed = pack_deformers(deformers);
    std::vector<Vec3> positions = face().positions;
    for (auto _ : state) {
        positions = face().positions;
        deform_points(packed, positions);
        benchmark::DoNotOptimize(positions.data());
    }
    per_vertex(state);
}

void patches_follow(benchmark::State& state) {
    const Face& at_rest = face();
    const std::vector<SurfaceAnchor> anchors = bind_to_patches(
        {at_rest.positions, at_rest.normals, at_rest.tangents}, at_rest.surface, at_rest.corners,
        1);
    std::vector<Vec4> patches;
    make_patches(at_rest.surface, at_rest.corners, patches);
    Face moved = at_rest;
    for (auto _ : state) {
        follow_patches(anchors, patches, moved.positions, moved.normals, moved.tangents);
        benchmark::DoNotOptimize(moved.positions.data());
    }
    per_vertex(state);
}

/// Positions only.
template <auto move>
void patches_move(benchmark::State& state) {
    const Face& at_rest = face();
    const std::vector<SurfaceAnchor> anchors = bind_to_patches(
        {at_rest.positions, at_rest.normals, at_rest.tangents}, at_rest.surface, at_rest.corners,
        1);
    const std::vector<std::uint32_t> order = order_by_patch(anchors);
    std::vector<Vec4> patches;
    make_patches(at_rest.surface, at_rest.corners, patches);
    std::vector<Vec3> positions = at_rest.positions;
    for (auto _ : state) {
        move({anchors, patches, order}, positions);
        benchmark::DoNotOptimize(positions.data());
    }
    per_vertex(state);
}

void patches_made(benchmark::State& state) {
    std::vector<Vec4> patches;
    for (auto _ : state) {
        make_patches(face().surface, face().corners, patches);
        benchmark::DoNotOptimize(patches.data());
    }
    per_vertex(state);
}

/// By eight faces each.
void faces_follow(benchmark::State& state) {
    const Face& at_rest = face();
    const SkinWeights weights = bind_to_faces(
        at_rest.positions, at_rest.normals, at_rest.surface, at_rest.corners, 4.0f, 8);
    const SkinData skin = make_face_skin(at_rest.surface, at_rest.corners);
    std::vector<Affine> frames(at_rest.corners.size() / 3);
    std::vector<Affine> palette(frames.size());
    Face moved = at_rest;
    for (auto _ : state) {
        compute_face_frames(at_rest.surface, at_rest.corners, frames);
        compute_skin_palette(skin, frames, palette);
        skin_linear(
            weights, palette, {at_rest.positions, at_rest.normals, at_rest.tangents},
            {moved.positions, moved.normals, moved.tangents}, 0, kVertices);
        benchmark::DoNotOptimize(moved.positions.data());
    }
    per_vertex(state);
}

BENCHMARK(muscles_and_lattice)->Unit(benchmark::kMicrosecond);
BENCHMARK(patches_follow)->Unit(benchmark::kMicrosecond);
BENCHMARK(patches_move<move_by_patches>)->Unit(benchmark::kMicrosecond);
BENCHMARK(patches_move<move_by_patches_scalar>)->Unit(benchmark::kMicrosecond);
BENCHMARK(patches_made)->Unit(benchmark::kMicrosecond);
BENCHMARK(faces_follow)->Unit(benchmark::kMicrosecond);

}  // namespace
