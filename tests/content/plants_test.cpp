#include "content/make/models/plants.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::plants_test {

using namespace limn::test;

namespace {

PlantShape small_tree() {
    return {.seed = 7, .area = {2, 3}, .stems = 5, .levels = 3, .branches = 4, .spread = 0.6f};
}

bool is_same(const PlantParticle& a, const PlantParticle& b) {
    return a.root == b.root && a.along == b.along && a.width == b.width
           && a.root_fraction == b.root_fraction;
}

/// How many of `plants` are not the same as those in their place of `others`, which may be longer.
std::size_t
differing(const std::vector<PlantParticle>& plants, const std::vector<PlantParticle>& others) {
    REQUIRE(plants.size() <= others.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < plants.size(); ++i) {
        count += is_same(plants[i], others[i]) ? 0 : 1;
    }
    return count;
}

}  // namespace

TEST_CASE(
    "plants: a description under 1 KB grows 16^5 leaves" * technique("particle.volume-fill")) {
    const PlantShape shape{.stems = 1, .levels = 5, .branches = 16};
    static_assert(sizeof(PlantShape) < 1024);
    const std::vector<PlantParticle> plants = grow_plants(shape);
    // 1 + 16 + .. + 16^5; the leaves are the last
    REQUIRE(plants.size() == 1118481);
    std::size_t leaves = 0;
    for (const PlantParticle& plant : plants) {
        leaves += plant.tip_fraction > 0.9999f ? 1 : 0;
    }
    CHECK(leaves == 1048576);
}

TEST_CASE(
    "plants: the same seed grows the same plants, another one entirely different ones"
    * technique("particle.volume-fill")) {
    const std::vector<PlantParticle> plants = grow_plants(small_tree());
    CHECK(differing(plants, grow_plants(small_tree())) == 0);
    PlantShape other = small_tree();
    other.seed = 8;
    CHECK(differing(plants, grow_plants(other)) == plants.size());
}

TEST_CASE(
    "plants: fewer levels are a prefix of more, in roots, tips and widths"
    * technique("particle.volume-fill")) {
    PlantShape shape = small_tree();
    const std::vector<PlantParticle> all = grow_plants(shape);
    CHECK(all.size() == 5 * (1 + 4 + 16 + 64));
    for (const int levels : {0, 1, 2}) {
        shape.levels = levels;
        const std::vector<PlantParticle> some = grow_plants(shape);
        REQUIRE(some.size() < all.size());
        for (std::size_t i = 0; i < some.size(); ++i) {
            CHECK(some[i].root == all[i].root);
            CHECK(some[i].along == all[i].along);
            CHECK(some[i].width == all[i].width);
        }
    }
}

TEST_CASE("plants: a branch begins at its parent's tip, within the spread of it") {
    const PlantShape shape = small_tree();
    const std::vector<PlantParticle> plants = grow_plants(shape);
    for (std::size_t i = 5; i < plants.size(); ++i) {
        const PlantParticle& parent = plants[(i - 5) / 4];  // of a forest in order of levels
        CHECK(plants[i].root == parent.root + parent.along);
        CHECK(plants[i].root_fraction == parent.tip_fraction);
        const float cosine =
            glm::dot(glm::normalize(plants[i].along), glm::normalize(parent.along));
        CHECK(cosine >= std::cos(shape.spread) - 1e-5f);
    }
}

TEST_CASE("plants: stems stand evenly on their area, within their spread of upright") {
    const PlantShape shape{.area = {4, 2}, .stems = 20000};
    int quarter = 0;
    double up = 0;
    for (const PlantParticle& plant : grow_plants(shape)) {
        REQUIRE(std::abs(plant.root.x) <= 2.0f);
        REQUIRE(std::abs(plant.root.z) <= 1.0f);
        CHECK(plant.root.y == 0.0f);
        quarter += plant.root.x > 1.0f ? 1 : 0;
        up += glm::normalize(plant.along).y;
    }
    CHECK(std::abs(quarter - 5000) < 4 * 61.2);  // four standard deviations of a quarter
    // mean cosine of directions even by solid angle within `spread`: (1 + cos) / 2; its standard
    // deviation is (1 - cos) / sqrt(12)
    const double cosine = std::cos(0.3);
    CHECK(std::abs(up / 20000 - (1 + cosine) / 2) < 4 * (1 - cosine) / std::sqrt(12.0 * 20000));
}

TEST_CASE(
    "plants: wind moves no root, the last tip by a fraction of the length, and bends between"
    * technique("particle.volume-fill")) {
    PlantShape shape = small_tree();
    const std::vector<PlantParticle> still = grow_plants(shape);
    const float length_sum = shape.length * (1 + 0.7f + 0.49f + 0.343f);
    PlantShape windy = shape;
    windy.wind = {0.4f, -0.1f, 0.2f};
    CHECK(differing(still, grow_plants(windy)) == 0);
    for (const PlantParticle& plant : still) {
        for (const float at : {0.0f, 0.25f, 1.0f}) {
            const Vec3 line = plant.root + at * plant.along;
            CHECK(plant_point(shape, plant, at) == line);
            const float fraction = std::lerp(plant.root_fraction, plant.tip_fraction, at);
            const Vec3 moved = plant_point(windy, plant, at) - line;
            CHECK(glm::distance(moved, windy.wind * length_sum * fraction * fraction) < 1e-5f);
        }
    }
    CHECK(plant_point(windy, still[0], 0) == still[0].root);
    const PlantParticle& leaf = still.back();
    CHECK(
        glm::distance(plant_point(windy, leaf, 1), leaf.root + leaf.along + windy.wind * length_sum)
        < 1e-5f);
}

TEST_CASE("plants: the mesh has two triangles per segment, one at a tip, and complete arrays") {
    PlantShape shape = small_tree();
    const MeshData mesh = make_plants(shape);
    check_arrays(mesh);
    CHECK(mesh.positions.size() == 425 * 8);
    CHECK(mesh.indices.size() == 3 * (105 * 6 + 320 * 5));
    shape.length_spread = 0;
    shape.spread = 0;
    // upright, the four lengths on each other
    CHECK(make_plants(shape).bounds.max.y == near(0.3f * (1 + 0.7f + 0.49f + 0.343f)));
}

TEST_CASE("plants: the largest request stays within two million particles") {
    const PlantShape shape{.stems = 100, .levels = 10, .branches = 16, .segments = 1};
    const std::vector<PlantParticle> plants = grow_plants(shape);
    CHECK(plants.size() == 100 * (1 + 16 + 256 + 4096));
    CHECK(plants.size() <= kMaxPlantParticles);
}

}  // namespace limn::plants_test
