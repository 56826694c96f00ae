#include "ecs/world.h"
#include "systems/faces/wrinkle_measure.h"
#include "systems/faces/wrinkle_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <limits>
#include <vector>

namespace limn::wrinkle_system_test {

using limn::test::near;

namespace {

/// Two triangles with a region "brow" over the first three vertices and "cheek" over all.
Assets two_regions() {
    Assets assets;
    MeshData& mesh = assets.meshes.emplace_back();
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.indices = {0, 1, 2, 2, 1, 3};
    mesh.regions.push_back(
        {.name = "brow",
         .weights = {1, 0.8f, 0.7f, 0},
         .across = std::vector<Vec3>(4, Vec3{1, 0, 0})});
    mesh.regions.push_back(
        {.name = "cheek",
         .weights = {0, 0.5f, 0.4f, 0.6f},
         .across = std::vector<Vec3>(4, Vec3{0, 1, 0})});
    assets.materials.emplace_back();
    return assets;
}

constexpr MeshInstance kInstance = {.mesh = {0}, .material = {0}};

}  // namespace

TEST_CASE(
    "wrinkle system: a mask is the sum of the regions, and the strongest gives the direction") {
    const Assets assets = two_regions();
    const WrinkleState all = make_wrinkle_state({}, kInstance, assets);
    CHECK(all.mask == std::vector<float>{1, 1, 1, 0.6f});
    const WrinkleState brow = make_wrinkle_state({.regions = {"brow"}}, kInstance, assets);
    CHECK(brow.mask == std::vector<float>{1, 0.8f, 0.7f, 0});
    CHECK(brow.rests[0].across[0] == Vec2{1, 0});
    const WrinkleState cheek = make_wrinkle_state({.regions = {"cheek"}}, kInstance, assets);
    CHECK(cheek.rests[0].across[0] == Vec2{0, 1});
}

TEST_CASE(
    "wrinkle system: folding at rest is the largest of the regions, by their weights"
    * technique("wrinkle.resting")) {
    const Assets assets = two_regions();
    const WrinkleSurface surface = {
        .resting = {{"brow", 0.2f}, {"cheek", 0.3f}, {"nose", 0.5f}}, .resting_shape = "age"};
    const WrinkleState state = make_wrinkle_state(surface, kInstance, assets);
    const float expected[] = {0.2f, 0.16f, 0.14f, 0.18f};
    REQUIRE(state.resting.size() == 4);
    for (std::size_t v = 0; v < 4; ++v) {
        CHECK(state.resting[v] == near(expected[v]));
    }
    CHECK(make_wrinkle_state({}, kInstance, assets).resting.empty());
    CHECK(make_wrinkle_state({.resting = {{"nose", 0.5f}}}, kInstance, assets).resting.empty());
    WrinkleSurface less = surface;
    less.resting[0].shortening = 0.1f;
    CHECK(state.source != make_wrinkle_state(less, kInstance, assets).source);
}

TEST_CASE(
    "wrinkle system: a state follows its mesh, its regions and its settings"
    * technique("wrinkle.compression.integration")) {
    World world;
    world.insert_resource(two_regions());
    const Entity entity = world.create(WrinkleSurface{}, kInstance);
    world.run(prepare_wrinkles);
    REQUIRE(world.find<WrinkleState>(entity) != nullptr);
    const std::uint64_t first = world.find<WrinkleState>(entity)->source;
    world.run(prepare_wrinkles);
    CHECK(world.find<WrinkleState>(entity)->source == first);

    world.find<WrinkleSurface>(entity)->regions = {"cheek"};
    world.run(prepare_wrinkles);
    CHECK(world.find<WrinkleState>(entity)->mask[0] == 0);

    ++world.find_resource<Assets>()->meshes[0].version;
    world.find_resource<Assets>()->meshes[0].regions[1].weights[0] = 0.25f;
    world.run(prepare_wrinkles);
    CHECK(world.find<WrinkleState>(entity)->mask[0] == 0.25f);

    world.find<WrinkleSurface>(entity)->regions = {"nose"};
    world.run(prepare_wrinkles);
    CHECK(world.find<WrinkleState>(entity) == nullptr);
}

TEST_CASE(
    "wrinkle system: regions of the wrong length and instances without a mesh have no state"
    * technique("wrinkle.compression.integration")) {
    Assets assets = two_regions();
    CHECK(wrinkle_source({}, {.mesh = {7}, .material = {0}}, assets) == 0);
    CHECK(wrinkle_source({}, {.mesh = {0}, .material = {9}}, assets) != 0);
    assets.meshes[0].regions[0].weights.pop_back();
    assets.meshes[0].regions[1].across.pop_back();
    CHECK(wrinkle_source({}, kInstance, assets) == 0);
    CHECK(make_wrinkle_state({}, kInstance, assets).rests.empty());
}

TEST_CASE(
    "wrinkle system: empty regions and weights that are NaN or beyond 1 give a mask of 0 to 1") {
    Assets assets = two_regions();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    assets.meshes[0].regions[0].weights = {10, nan, -3, 0.25f};
    assets.meshes[0].regions[1].weights.assign(4, 0.0f);
    const WrinkleState state = make_wrinkle_state({}, kInstance, assets);
    CHECK(state.mask == std::vector<float>{1, 0, 0, 0.25f});
    const WrinkleState empty = make_wrinkle_state({.regions = {"cheek"}}, kInstance, assets);
    CHECK(empty.mask == std::vector<float>(4, 0.0f));
    for (const float ratio : vertex_compression(empty.rests, assets.meshes[0].positions)) {
        CHECK(ratio == 1);
    }
}

TEST_CASE("wrinkle system: two layers have a rest and a mask each, along the folds if rotated") {
    const Assets assets = two_regions();
    const WrinkleState two =
        make_wrinkle_state({.regions = {"brow"}, .second_regions = {"cheek"}}, kInstance, assets);
    REQUIRE(two.rests.size() == 2);
    CHECK(two.mask == std::vector<float>{1, 0.8f, 0.7f, 0});
    CHECK(two.second_mask == std::vector<float>{0, 0.5f, 0.4f, 0.6f});
    CHECK(two.rests[1].across[0] == Vec2{0, 1});
    // By a driver without directions there is one layer.
    CHECK(make_wrinkle_state(
              {.second_regions = {"cheek"}, .driver = WrinkleDriver::Edge}, kInstance, assets)
              .second_mask.empty());
}

TEST_CASE("wrinkle system: each driver measures the quantity in its name") {
    Assets assets = two_regions();
    const auto state = [&](WrinkleDriver driver) {
        return make_wrinkle_state({.driver = driver, .radius = 1}, kInstance, assets);
    };
    CHECK(state(WrinkleDriver::Chord).rests.size() == 1);
    CHECK(state(WrinkleDriver::Edge).rests[0].across.size() == 6);
    CHECK(state(WrinkleDriver::Strain).rests.size() == 3);
    CHECK(state(WrinkleDriver::Radial).rests.empty());
    CHECK(state(WrinkleDriver::Chord).source != state(WrinkleDriver::Edge).source);
    // Without directions a chord is the mean of two, and others never have one.
    for (VertexRegion& region : assets.meshes[0].regions) {
        region.across.clear();
    }
    CHECK(state(WrinkleDriver::Chord).rests[0].across.size() == 4);
    CHECK(state(WrinkleDriver::Chord).mask == std::vector<float>{1, 1, 1, 0.6f});
    CHECK(state(WrinkleDriver::Edge).mask == std::vector<float>{1, 1, 1, 0.6f});
    assets.meshes[0].regions.clear();
    CHECK(state(WrinkleDriver::Chord).source == 0);
    CHECK(state(WrinkleDriver::Strain).mask == std::vector<float>(4, 1.0f));
}

TEST_CASE(
    "wrinkle system: a radial driver is strongest at its center and none at its radius"
    * technique("wrinkle.compression.prior-models")) {
    const Assets assets = two_regions();
    const WrinkleState state =
        make_wrinkle_state({.driver = WrinkleDriver::Radial, .radius = 1}, kInstance, assets);
    CHECK(state.mask[0] == 1);
    CHECK(state.mask[1] == 0);  // at 1 m
    CHECK(state.mask[3] == 0);
    // The same in all directions, and falling.
    float before = 1;
    for (int i = 1; i < 12; ++i) {
        const float r = 0.1f * static_cast<float>(i);
        const float falloff = radial_falloff({1 + r, 2, 3}, {1, 2, 3}, 1);
        CHECK(falloff == near(radial_falloff({1, 2 - 0.6f * r, 3 + 0.8f * r}, {1, 2, 3}, 1)));
        CHECK((falloff < before || falloff == 0));
        CHECK((falloff == 0) == (i >= 10));
        before = falloff;
    }
}

}  // namespace limn::wrinkle_system_test
