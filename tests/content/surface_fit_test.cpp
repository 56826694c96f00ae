#include "content/bake/surface_fit.h"
#include "content/make/models/shapes.h"
#include "ecs/base/rng.h"
#include "ecs/base/triangle.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::surface_fit_test {

using test::near;

namespace {

MeshData make_ball(float radius, int segments) {
    return make_sphere({.radius = radius, .segments = segments, .rings = segments / 2});
}

float distance_to_mesh(const Vec3& p, const MeshData& mesh) {
    float nearest = INFINITY;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        nearest = std::min(
            nearest, distance_to_triangle(
                         p, mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                         mesh.positions[mesh.indices[i + 2]]));
    }
    return nearest;
}

/// A target that is neither round nor like the surface that is fitted to it.
MeshData make_target() {
    MeshData target = make_ball(1, 40);
    for (Vec3& p : target.positions) {
        p = Vec3(1.2f * p.x + 0.1f * std::sin(4 * p.y), 1.1f * p.y, 0.9f * p.z + 0.15f * p.x * p.x);
    }
    return target;
}

}  // namespace

TEST_CASE(
    "surface fit: energy never rises, and vertices end on the target"
    * technique("face.retarget-fit")) {
    const MeshData coarse = make_ball(1, 16);
    const MeshData target = make_target();
    const SurfaceFit fit = fit_surface(
        coarse.positions, coarse.indices, target.positions, target.indices,
        {.strain = 0.02f, .bending = 0.02f, .distance = 1}, 40);
    REQUIRE(fit.energies.size() > 3);
    for (std::size_t i = 1; i < fit.energies.size(); ++i) {
        CHECK(fit.energies[i] <= fit.energies[i - 1]);
    }
    CHECK(fit.energies.back() < 0.3 * fit.energies.front());
    float farthest = 0.0f;
    for (std::size_t v = 0; v < fit.positions.size(); ++v) {
        farthest = std::max(farthest, distance_to_mesh(fit.positions[v], target));
    }
    CHECK(farthest < 0.02f);
}

TEST_CASE(
    "surface fit: the more strain and bending cost, the more of the structure is kept"
    * technique("face.retarget-fit")) {
    const MeshData coarse = make_ball(1, 16);
    const MeshData target = make_target();
    float last = 0.0f;
    for (const float stiffness : {10.0f, 0.3f, 0.01f}) {
        const SurfaceFit fit = fit_surface(
            coarse.positions, coarse.indices, target.positions, target.indices,
            {.strain = stiffness, .bending = stiffness, .distance = 1}, 20);
        float strain = 0.0f;
        for (std::size_t i = 0; i < coarse.indices.size(); i += 3) {
            const std::uint32_t a = coarse.indices[i];
            const std::uint32_t b = coarse.indices[i + 1];
            const Vec3 rest = coarse.positions[a] - coarse.positions[b];
            strain += glm::distance(fit.positions[a] - fit.positions[b], rest);
        }
        CHECK(strain > 1.2f * last);
        last = strain;
    }
}

TEST_CASE("surface fit: a surface on the target does not move" * technique("face.retarget-fit")) {
    const MeshData ball = make_ball(1, 16);
    const SurfaceFit fit =
        fit_surface(ball.positions, ball.indices, ball.positions, ball.indices, {}, 10);
    for (std::size_t v = 0; v < ball.positions.size(); ++v) {
        CHECK(glm::distance(fit.positions[v], ball.positions[v]) < 1e-6f);
    }
    CHECK(fit.energies.back() < 1e-10);
}

TEST_CASE(
    "surface fit: a label is the vertex nearest to a marker" * technique("face.retarget-fit")) {
    const MeshData ball = make_ball(1, 24);
    std::vector<Vec3> points;
    for (const std::uint32_t v : {40u, 57u, 120u}) {
        points.push_back(1.05f * ball.positions[v]);
    }
    CHECK(label_vertices(points, ball.positions) == std::vector<std::uint32_t>{40, 57, 120});
}

TEST_CASE("triangle: the nearest point is within it, and no other is nearer") {
    Random random(1, 6, 1, 8);
    for (int i = 0; i < 200; ++i) {
        const Vec3 a = random.direction();
        const Vec3 b = i % 10 == 0 ? a : random.direction();
        const Vec3 c = random.direction();
        const Vec3 p = 2.0f * random.direction();
        const float nearest = glm::distance(p, nearest_on_triangle(p, a, b, c));
        float sampled = INFINITY;
        for (int j = 0; j <= 40; ++j) {
            for (int k = 0; j + k <= 40; ++k) {
                const Vec2 at = Vec2(j, k) / 40.0f;
                sampled = std::min(
                    sampled, glm::distance(p, at.x * a + at.y * b + (1 - at.x - at.y) * c));
            }
        }
        CHECK(nearest <= sampled + 1e-6f);
        CHECK(nearest > sampled - 0.06f);
    }
}

TEST_CASE(
    "retarget: motion is scaled and turned as one face is by the other"
    * technique("face.retarget-warp")) {
    std::vector<Vec3> from;
    Random random(3, 3, 3, 3);
    for (int i = 0; i < 20; ++i) {
        from.push_back(random.uniform() * random.direction());
    }
    const auto warp_by = [&](const Affine& map) {
        std::vector<Vec3> to;
        for (const Vec3& p : from) {
            to.push_back(transform_point(map, p));
        }
        return *make_point_warp(from, to);
    };
    const Affine same;
    const Affine larger = affine_from({1, 2, 3}, Quat(1, 0, 0, 0), Vec3(1.7f));
    const Affine turned =
        affine_from({0, 1, 0}, glm::normalize(Quat(0.8f, 0.1f, -0.5f, 0.2f)), Vec3(1));
    for (const Vec3& rest : from) {
        const Vec3 offset = 0.1f * random.direction();
        for (const Affine& map : {same, larger, turned}) {
            CHECK(
                glm::distance(
                    warp_offset(warp_by(map), rest, offset), transform_vector(map, offset))
                < 1e-5f);
        }
        CHECK(warp_offset(warp_by(larger), rest, Vec3(0)) == Vec3(0));
        CHECK(glm::distance(warp_offset(warp_by(same), rest, offset, 1.5f), 1.5f * offset) < 1e-5f);
    }
}

}  // namespace limn::surface_fit_test
