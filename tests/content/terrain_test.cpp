#include "content/make/models/terrain.h"
#include "content/make/patterns/noise.h"
#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"

#include <doctest/doctest.h>

namespace limn::terrain_test {

using namespace limn::test;

TEST_CASE("terrain: a landscape is a proper mesh within its size and about its height") {
    const TerrainShape shape = {.size = {80, 60}, .divisions = 96, .height = 10};
    const MeshData land = make_terrain(shape);
    check_arrays(land);
    CHECK(land.positions.size() == 97 * 97);
    CHECK(land.indices.size() == 96 * 96 * 6);
    CHECK(land.bounds.min.x == -40);
    CHECK(land.bounds.max.z == 30);
    CHECK(land.bounds.min.y > -1.0f);
    CHECK(land.bounds.max.y < 11.0f);
    CHECK(land.bounds.max.y - land.bounds.min.y > 4.0f);
    CHECK(worst_facing(land) > 0.5f);
}

TEST_CASE("terrain: vertices are at the height of the function, whatever the number of quads") {
    const TerrainShape coarse = {.size = {64, 64}, .divisions = 16};
    const TerrainShape fine = {.size = {64, 64}, .divisions = 64};
    for (const TerrainShape& shape : {coarse, fine}) {
        for (const Vec3& p : make_terrain(shape).positions) {
            REQUIRE(p.y == terrain_height(coarse, p.x, p.z));
        }
    }
}

TEST_CASE("terrain: the same seed gives the same bits on any number of threads, another seed other "
          "hills") {
    const auto bits = [](const TerrainShape& shape) {
        const MeshData land = make_terrain(shape);
        return hash_bytes(
            std::as_bytes(std::span(land.positions)),
            hash_bytes(std::as_bytes(std::span(land.normals))));
    };
    const int threads = thread_count();
    set_thread_count(1);
    const std::uint64_t one = bits({.divisions = 64});
    set_thread_count(4);
    CHECK(bits({.divisions = 64}) == one);
    set_thread_count(threads);
    CHECK(bits({.divisions = 64, .seed = 2}) != one);
}

TEST_CASE("terrain: the clearing is level and joins the hills without a step") {
    const TerrainShape shape = {.clearing = 10};
    const float level = terrain_height(shape, 0, 0);
    CHECK(terrain_height(shape, 9.9f, 0) == level);
    CHECK(terrain_height(shape, 0, -7) == level);
    float last = terrain_height(shape, 9, 0);
    for (float x = 9; x < 25; x += 0.05f) {
        const float height = terrain_height(shape, x, 0);
        CHECK(std::abs(height - last) < 0.15f);
        last = height;
    }
    CHECK(terrain_height(shape, 30, 30) == terrain_height(TerrainShape{}, 30, 30));
}

TEST_CASE("terrain: an island rises from its coast, and is unchanged far from it") {
    const TerrainShape island = {.size = {200, 100}, .shore = 20};
    const TerrainShape land = {.size = {200, 100}};
    for (int i = 0; i < 64; ++i) {
        const float angle = 0.0981748f * static_cast<float>(i);
        const Vec2 coast(100 * std::cos(angle), 50 * std::sin(angle));
        // Around it lies the seabed, so deep that the sea hides where the mesh ends, and it gets
        // there without a step.
        const float seabed = -0.05f * island.height - 0.3f * 50;
        CHECK(terrain_height(island, 1.0001f * coast.x, 1.0001f * coast.y) == near(seabed));
        CHECK(terrain_height(island, 1.2f * coast.x, 1.2f * coast.y) == seabed);
        float last = terrain_height(island, 0.8f * coast.x, 0.8f * coast.y);
        for (float t = 0.8f; t < 1; t += 0.0025f) {
            const float height = terrain_height(island, t * coast.x, t * coast.y);
            CHECK(std::abs(height - last) < 1.5f);
            last = height;
        }
        CHECK(
            terrain_height(island, 0.55f * coast.x, 0.55f * coast.y)
            == terrain_height(land, 0.55f * coast.x, 0.55f * coast.y));
        CHECK(
            terrain_height(island, 0.8f * coast.x, 0.8f * coast.y)
            < terrain_height(land, 0.8f * coast.x, 0.8f * coast.y));
    }
}

TEST_CASE("terrain: erosion takes detail from slopes") {
    const auto roughness = [](float erosion) {
        const TerrainShape shape = {.ridges = 0, .erosion = erosion};
        double sum = 0;
        for (int i = 0; i < 400; ++i) {
            const float x = static_cast<float>(i) * 0.2f;
            sum += std::abs(
                terrain_height(shape, x + 0.1f, 3) - 2 * terrain_height(shape, x, 3)
                + terrain_height(shape, x - 0.1f, 3));
        }
        return sum;
    };
    CHECK(roughness(2) < 0.7 * roughness(0));
}

TEST_CASE("noise: the slope of gradient noise agrees with differences") {
    for (int i = 0; i < 50; ++i) {
        const Vec2 p = {0.37f * static_cast<float>(i), -0.21f * static_cast<float>(i)};
        const float h = 1e-2f;
        const NoiseSample n = gradient_noise_slope(p, 5);
        const float dx =
            (gradient_noise(p + Vec2(h, 0), 5) - gradient_noise(p - Vec2(h, 0), 5)) / (2 * h);
        const float dy =
            (gradient_noise(p + Vec2(0, h), 5) - gradient_noise(p - Vec2(0, h), 5)) / (2 * h);
        CHECK(n.slope.x == test::near(dx).epsilon(1e-2).scale(1));
        CHECK(n.slope.y == test::near(dy).epsilon(1e-2).scale(1));
    }
}

TEST_CASE("noise: it is 0 at lattice points, has mean 0 and stays within -1 .. 1") {
    CHECK(gradient_noise({3, -7}, 1) == 0);
    double sum = 0;
    float least = 0;
    float most = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec2 p = {lattice_random(i, 0, 9) * 100, lattice_random(i, 1, 9) * 100};
        const float n = gradient_noise(p, 2);
        sum += static_cast<double>(n);
        least = std::min(least, n);
        most = std::max(most, n);
    }
    CHECK(std::abs(sum / 20000) < 0.01);
    CHECK(least >= -1.0f);
    CHECK(most <= 1.0f);
    CHECK(most > 0.6f);
    CHECK(least < -0.6f);
}

TEST_CASE("noise: with a period it repeats, octaves and cells too") {
    for (int i = 0; i < 40; ++i) {
        const Vec2 p = {0.25f * static_cast<float>(i), 1.75f};
        const Vec2 q = p + Vec2(8, -16);
        CHECK(
            fractal_noise(p, 3, {.count = 4}, IVec2(8))
            == test::near(fractal_noise(q, 3, {.count = 4}, IVec2(8))));
        CHECK(
            ridged_noise(p, 3, {.count = 4}, IVec2(8))
            == test::near(ridged_noise(q, 3, {.count = 4}, IVec2(8))));
        CHECK(cell_noise(p, 3, 1, IVec2(8)).cell == cell_noise(q, 3, 1, IVec2(8)).cell);
        CHECK(
            cell_noise(p, 3, 1, IVec2(8)).edge
            == test::near(cell_noise(q, 3, 1, IVec2(8)).edge).scale(1));
    }
}

TEST_CASE("noise: the second octave of a tile does not repeat within it") {
    float apart = 0;
    for (int i = 0; i < 20; ++i) {
        const Vec2 p = {0.31f * static_cast<float>(i), 0.17f * static_cast<float>(i)};
        const auto second = [](const Vec2& q) {
            const Octaves two = {.count = 2, .gain = 0.5f};
            return 1.5f * fractal_noise(q, 3, two, IVec2(8)) - gradient_noise(q, 3, IVec2(8));
        };
        apart = std::max(apart, std::abs(second(p) - second(p + Vec2(4, 0))));
    }
    CHECK(apart > 0.1f);
}

TEST_CASE("noise: the border of a cell is where two feature points are equally distant") {
    float least = 1;
    for (int i = 0; i < 2000; ++i) {
        const CellSample c =
            cell_noise({lattice_random(i, 0, 1) * 20, lattice_random(i, 1, 1) * 20}, 4);
        REQUIRE(c.nearest <= c.second);
        REQUIRE(c.edge >= 0.5f * (c.second - c.nearest) - 1e-4f);
        if (c.edge < 0.01f) {
            CHECK(c.second - c.nearest < 0.1f);
        }
        least = std::min(least, c.edge);
    }
    CHECK(least < 0.01f);
}

}  // namespace limn::terrain_test
