#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "bench/characters/scalar_pose.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/skin_kernels.h"

#include <vector>

namespace limn::bench {

void add_vertex_rows(CharacterBench& bench);

void add_vertex_rows(CharacterBench& bench) {
    constexpr std::size_t kVertices = 20000;
    constexpr std::size_t kJoints = 67;
    constexpr std::size_t kInfluences = 4;
    Random random(1, 0, name_hash("bench vertices"), 0);
    std::vector<Affine> palette;
    for (std::size_t i = 0; i < kJoints; ++i) {
        palette.push_back(
            affine_from(random.direction(), rotation_about(random.direction(), 0.5f), Vec3(1)));
    }
    SkinWeights skin;
    skin.first.push_back(0);
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    for (std::size_t v = 0; v < kVertices; ++v) {
        positions.push_back(random.direction());
        normals.push_back(random.direction());
        const std::size_t first = v * (kJoints - kInfluences) / kVertices;
        for (std::size_t i = 0; i < kInfluences; ++i) {
            skin.joints.push_back(static_cast<std::uint16_t>(first + i));
            skin.weights.push_back(0.25f);
        }
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    }
    std::vector<Vec3> moved_positions(kVertices);
    std::vector<Vec3> moved_normals(kVertices);
    const std::vector<Vec4> tangents(kVertices, Vec4(1, 0, 0, 1));
    std::vector<Vec4> moved_tangents(kVertices);
    const auto [ours, scalar] = race(
        thread_seconds, bench.repeats,
        [&] {
            skin_linear(
                skin, palette, {positions, normals, tangents},
                {moved_positions, moved_normals, moved_tangents}, 0, kVertices);
        },
        [&] {
            skin_vertices_scalar(
                &palette[0].row[0].x, skin.joints.data(), skin.weights.data(), kInfluences,
                &positions[0].x, &normals[0].x, kVertices, &moved_positions[0].x,
                &moved_normals[0].x);
        });
    constexpr double kNs = 1e9 / kVertices;
    bench.add(
        {.gate = "9",
         .name = "vertices of 4 influences, with normals",
         .ours = ours * kNs,
         .reference = scalar * kNs,
         .against = "scalar, floats",
         .limit = 0.25,
         .stretch = 0.15,
         .peer = "0.18 (ozz)",
         .vectors = true});
}

}  // namespace limn::bench
