#include "content/make/models/shapes.h"
#include "ecs/base/triangle.h"
#include "render/geometry/coarse_triangles.h"
#include "render/geometry/triangle_grid.h"
#include "tests/near.h"
#include "tests/render/shadow_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace limn::test::coarse_triangles_test {
namespace {

/// The least distance of `p` from any triangle, by a loop over all.
float nearest_of_all(const Vec3& p, const MeshData& mesh, std::span<const std::uint32_t> indices) {
    float nearest = INFINITY;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        nearest = std::min(
            nearest, distance_to_triangle(
                         p, mesh.positions[indices[i]], mesh.positions[indices[i + 1]],
                         mesh.positions[indices[i + 2]]));
    }
    return nearest;
}

SpotLight narrow_spot() {
    return {
        .intensity = 10,
        .radius = 0,
        .attenuation = {.falloff = Falloff::None},
        .inner_angle = radians(20.0f),
        .outer_angle = radians(20.0f)};
}

MeshData ball() {
    return make_sphere({.radius = 0.5f, .segments = 48, .rings = 24});
}

}  // namespace

TEST_CASE("triangle grid: the distance of a triangle is that of its side, edge or corner") {
    const Vec3 a = {0, 0, 0};
    const Vec3 b = {2, 0, 0};
    const Vec3 c = {0, 2, 0};
    CHECK(distance_to_triangle({0.5f, 0.5f, 3}, a, b, c) == near(3));
    CHECK(distance_to_triangle({0.5f, -2, 0}, a, b, c) == near(2));
    CHECK(distance_to_triangle({-3, -4, 0}, a, b, c) == near(5));
    CHECK(distance_to_triangle({2, 2, 0}, a, b, c) == near(std::sqrt(2.0)));
    CHECK(distance_to_triangle({1, 1, 1}, a, b, b) == near(std::sqrt(2.0)));  // a line
    CHECK(distance_to_triangle({3, 4, 0}, a, a, a) == near(5));               // a point
}

TEST_CASE("triangle grid: it finds the same distances as a loop over all triangles") {
    const MeshData mesh = ball();
    const TriangleGrid grid(mesh.positions, mesh.indices);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-1, 1);
    for (int i = 0; i < 300; ++i) {
        const Vec3 p = {place(random), place(random), place(random)};
        CHECK(grid.distance(p, 0) == near(nearest_of_all(p, mesh, mesh.indices)));
    }
}

TEST_CASE(
    "triangle grid: long thin triangles in all directions have few entries and correct distances") {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> place(-1, 1);
    MeshData mesh;
    for (std::uint32_t i = 0; i < 6000; ++i) {
        if (i % 3 != 1) {
            mesh.positions.emplace_back(place(random), place(random), place(random));
        } else {
            mesh.positions.push_back(mesh.positions.back() + Vec3(0.001f));
        }
        mesh.indices.push_back(i);
    }
    const TriangleGrid grid(mesh.positions, mesh.indices);
    CHECK(grid.entries() <= 32 * 2000);
    for (int i = 0; i < 20; ++i) {
        const Vec3 p = {place(random), place(random), place(random)};
        CHECK(grid.distance(p, 0) == near(nearest_of_all(p, mesh, mesh.indices)));
    }
}

TEST_CASE("coarse triangles: a million points or lines are not simplified, a surface is") {
    constexpr int kSide = 320;  // quads of two triangles each
    const MeshData surface = make_plane({.size = {2, 2}, .divisions = kSide});
    MeshData loose;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const auto first = static_cast<std::uint32_t>(loose.positions.size());
            for (const Vec3& corner :
                 {Vec3(0, 0, 0), Vec3(0, 0.5f, 0), Vec3(1, 0, 0), Vec3(1, 0.5f, 0)}) {
                // No two quads at the same position.
                loose.positions.push_back(corner + Vec3(x, y, kSide * y + x));
            }
            for (const std::uint32_t corner : {0u, 2u, 1u, 1u, 2u, 3u}) {
                loose.indices.push_back(first + corner);
            }
        }
    }
    REQUIRE(loose.indices.size() == surface.indices.size());
    CHECK(simplify_triangles(loose).empty());
    CHECK_FALSE(simplify_triangles(surface).empty());
}

TEST_CASE("coarse triangles: every vertex of the mesh is within the error of each level") {
    for (const MeshData& mesh :
         {ball(), make_torus({.segments = 32, .sides = 16}), make_box({.bevel = 0.05f})}) {
        const std::vector<CoarseTriangles> levels = simplify_triangles(mesh);
        CHECK(levels.size() >= 3);
        std::size_t count = mesh.indices.size();
        float error = 0;
        for (const CoarseTriangles& level : levels) {
            CHECK(level.indices.size() % 3 == 0);
            CHECK(static_cast<double>(level.indices.size()) <= 0.75 * static_cast<double>(count));
            CHECK(level.error >= error);
            float farthest = 0;
            for (const Vec3& p : mesh.positions) {
                farthest = std::max(farthest, nearest_of_all(p, mesh, level.indices));
            }
            CHECK(farthest <= level.error * 1.0001f);
            count = level.indices.size();
            error = level.error;
        }
        CHECK(error > 0);
    }
}

TEST_CASE("coarse triangles: a flat plate keeps its error of 0 down to few triangles") {
    const std::vector<CoarseTriangles> levels =
        simplify_triangles(make_plane({.size = {2, 2}, .divisions = 16}));
    REQUIRE(!levels.empty());
    CHECK(levels[0].error < 1e-6f);
}

TEST_CASE("coarse triangles: small meshes and those with NaN positions have none") {
    CHECK(simplify_triangles(make_box({})).empty());
    CHECK(simplify_triangles(MeshData{}).empty());
    MeshData broken = ball();
    broken.positions[7].y = NAN;
    CHECK(simplify_triangles(broken).empty());
}

TEST_CASE(
    "coarse triangles: seams of texture coordinates are welded, except in meshes with morphs") {
    MeshData twice = make_plane({.size = {2, 2}, .divisions = 16});
    const auto half = static_cast<std::uint32_t>(twice.positions.size());
    const std::vector<Vec3> copies = twice.positions;
    twice.positions.insert(twice.positions.end(), copies.begin(), copies.end());
    for (std::size_t i = 0; i < twice.indices.size(); i += 6) {
        for (std::size_t j = i; j < i + 3; ++j) {
            twice.indices[j] += half;  // every other triangle has vertices of its own
        }
    }
    const auto uses_copies = [&] {
        const std::vector<CoarseTriangles> levels = simplify_triangles(twice);
        return std::any_of(levels.begin(), levels.end(), [&](const CoarseTriangles& level) {
            const auto [low, high] =
                std::minmax_element(level.indices.begin(), level.indices.end());
            return *low < half && *high >= half;
        });
    };
    CHECK_FALSE(simplify_triangles(twice).empty());
    const float error = simplify_triangles(twice)[0].error;
    CHECK(error < 1e-6f);
    twice.morphs.emplace_back();
    CHECK((simplify_triangles(twice).empty() || uses_copies()));
}

TEST_CASE_FIXTURE(
    ShadowTest,
    "coarse triangles: a ball's shadow differs only at its edge, by the detail and a texel") {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    put(make_sphere({.radius = 0.5f, .segments = 96, .rings = 48}), {0, 1, 0});
    const Entity lamp = shine(narrow_spot(), look_at({0, 6, 0.01f}, {0, 0, 0}));
    const RenderView view = look({1, 2, 1}, {0, 0, 0}, 160, 160);
    world.add(lamp, Shadow{.filter = ShadowFilter::Hard, .resolution = 128, .detail = 0});
    const std::vector<Receiver> exact = receivers(lamp, view);
    const double texel = 2 * std::tan(radians(20.0)) * 6 / 124;
    // The cone of light about the ball touches it at sqrt(5^2 - 0.5^2).
    const double edge = 6 * 0.5 / std::sqrt(25 - 0.25);
    for (const double detail : {0.5, 3.0}) {
        world.get<Shadow>(lamp).detail = static_cast<float>(detail);
        const std::vector<Receiver> coarse = receivers(lamp, view);
        int dark = 0;
        int other = 0;
        double farthest = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            const Receiver& r = exact[i];
            if (r.valid && r.position.y < 0.01) {
                dark += r.visibility < 0.5 ? 1 : 0;
            }
            if (r.valid && r.position.y < 0.01 && r.visibility != coarse[i].visibility) {
                ++other;
                const double from = std::hypot(r.position.x, r.position.z) - edge;
                farthest = std::max(farthest, std::abs(from));
            }
        }
        CAPTURE(detail);
        CHECK(dark > 500);
        CHECK((other > 0 || detail < 1));
        CHECK(farthest < (detail + 1) * texel * 6 / 5);  // on the floor, behind the ball
    }
}

TEST_CASE_FIXTURE(
    ShadowTest, "coarse triangles: a plate without error shadows the floor close below it") {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    put(make_plane({.size = {1, 1}, .divisions = 32}), {0, 0.2f, 0});
    const Entity lamp = shine(narrow_spot(), look_at({0, 6, 0.01f}, {0, 0, 0}));
    const RenderView view = look({1.2f, 0.15f, 0}, {0, 0.05f, 0}, 160, 160);
    world.add(lamp, Shadow{.filter = ShadowFilter::Hard, .resolution = 128, .detail = 0});
    const std::vector<Receiver> exact = receivers(lamp, view);
    world.get<Shadow>(lamp).detail = 8;  // 0.28 m: more than the plate's height
    const std::vector<Receiver> coarse = receivers(lamp, view);
    int dark = 0;
    int other = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        dark += exact[i].valid && exact[i].visibility < 0.5 ? 1 : 0;
        other += exact[i].valid && exact[i].visibility != coarse[i].visibility ? 1 : 0;
    }
    CHECK(dark > 500);
    CHECK(other == 0);
}

TEST_CASE_FIXTURE(
    ShadowTest, "coarse triangles: a hollow is not shadowed by triangles that span it") {
    MeshData hollow = make_plane({.size = {4, 4}, .divisions = 64});
    for (std::size_t i = 0; i < hollow.positions.size(); ++i) {
        Vec3& p = hollow.positions[i];
        p.y = 0.25f * (p.x * p.x + p.z * p.z);
        hollow.normals[i] = glm::normalize(Vec3(-0.5f * p.x, 1, -0.5f * p.z));
    }
    put(hollow, {0, 0, 0});
    const auto lit = [&](Entity lamp, float detail) {
        world.add(lamp, Shadow{.filter = ShadowFilter::Hard, .resolution = 512, .detail = detail});
        const std::vector<Receiver> seen = receivers(lamp, look({1, 5, 1}, {0, 0, 0}, 160, 160));
        const auto there =
            std::count_if(seen.begin(), seen.end(), [](const Receiver& r) { return r.valid; });
        const auto bright = std::count_if(seen.begin(), seen.end(), [](const Receiver& r) {
            return r.valid && r.visibility > 0.5;
        });
        world.destroy(lamp);
        return static_cast<double>(bright) / static_cast<double>(there);
    };
    const Affine above = look_at({0, 6, 0.01f}, {0, 0, 0});
    const SpotLight spot = {.radius = 0, .inner_angle = 0.5f, .outer_angle = 0.6f};
    for (const float detail : {1.0f, 8.0f}) {
        CHECK(lit(shine(spot, above), detail) == 1);
        CHECK(lit(shine(DirectionalLight{}, above), detail) == 1);
    }
}

}  // namespace limn::test::coarse_triangles_test
