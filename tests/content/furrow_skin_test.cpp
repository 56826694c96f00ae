// Furrows on entities, which are updated when their inputs change.

#include "content/bake/furrow_height.h"
#include "content/bake/furrow_recipe.h"
#include "content/bake/furrow_skin.h"
#include "content/make/patterns/furrow_patterns.h"
#include "ecs/base/hash.h"
#include "ecs/world.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::test::furrow_skin_test {
namespace {

constexpr int kSize = 96;
const FurrowArrow kArrow = {{0, 0, 0}, {0.5f, 1, 0}, {1, 0, 0}};

ImageData blank_image(int size, bool srgb = false) {
    return {
        .name = "blank",
        .width = size,
        .height = size,
        .srgb = srgb,
        .pixels = std::vector<std::uint8_t>(static_cast<std::size_t>(4 * size * size), 7)};
}

/// A square with furrows.
struct Sample {
    World world;
    Entity entity;

    explicit Sample(Furrows furrows = {.arrows = {kArrow}}) {
        Assets assets;
        assets.meshes.push_back(make_furrow_surface(FurrowSurface::Square));
        assets.images = {blank_image(kSize), blank_image(kSize)};
        world.insert_resource(std::move(assets));
        furrows.normals = {0};
        furrows.heights = {1};
        entity = world.create(furrows, MeshInstance{{0}, {}});
        update();
    }
    void update() { world.run(update_furrow_skins); }
    Furrows& furrows() { return world.get<Furrows>(entity); }
    const FurrowSkin& skin() { return *std::as_const(world).find<FurrowSkin>(entity); }
    std::uint64_t growth_hash() {
        const FurrowGrowth& growth = skin().growth;
        return hash_bytes(growth.height.data(), growth.height.size() * sizeof(float));
    }
};

}  // namespace

TEST_CASE(
    "furrow skin: its images are the maps that the same recipe bakes"
    * technique("wrinkle.furrow.editor")) {
    Sample sample;
    FurrowRecipe recipe = {.size = kSize, .arrows = {kArrow}};
    FurrowMaps maps = make_furrow_maps(
        *lay_out_furrows(make_furrow_surface(FurrowSurface::Square), recipe), recipe.style);
    add_furrow_gutter(maps, 4);
    float most = 0;
    int furrowed = 0;
    for (std::size_t i = 0; i < maps.height.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const float decoded =
                static_cast<float>(sample.skin().normals[4 * i + static_cast<std::size_t>(c)])
                    / 127.5f
                - 1.0f;
            most = std::max(most, std::abs(decoded - maps.normals[i][c]));
        }
        most = std::max(
            most, std::abs(
                      static_cast<float>(sample.skin().heights[4 * i]) / 255.0f
                      - std::clamp(maps.height[i], 0.0f, 1.0f)));
        furrowed += maps.height[i] < 0.9f ? 1 : 0;
    }
    CHECK(most <= 0.5f / 127.0f);
    CHECK(furrowed > 500);
}

TEST_CASE("furrow skin: unchanged furrows are not regrown" * technique("wrinkle.furrow.editor")) {
    Sample sample;
    const std::uint32_t version = sample.skin().version;
    sample.update();
    CHECK(sample.skin().version == version);
    sample.furrows().style.seed = 9;
    sample.update();
    CHECK(sample.skin().version != version);
}

TEST_CASE(
    "furrow skin: noise and bump leave the noiseless height alone, the scale does not"
    * technique("wrinkle.furrow.editor")) {
    Sample sample;
    const std::uint64_t grown = sample.growth_hash();
    const std::vector<std::uint8_t> normals = sample.skin().normals;
    sample.furrows().style.noise = 0.3f;
    sample.furrows().style.bump = 0.9f;
    sample.update();
    CHECK(sample.growth_hash() == grown);
    CHECK(sample.skin().normals != normals);
    sample.furrows().style.scale = 1.5f;
    sample.update();
    CHECK(sample.growth_hash() != grown);
}

TEST_CASE(
    "furrow skin: pending edits show only at their own vertex until their step"
    * technique("wrinkle.furrow.editor")) {
    Sample sample;
    Furrows& furrows = sample.furrows();
    furrows.hold = {true, furrows.arrows, furrows.arrows, furrows.style};
    sample.update();
    const std::uint64_t grown = sample.growth_hash();
    const std::vector<FurrowVectors> field = sample.skin().field;

    furrows.arrows.push_back({{0.5f, 0.5f, 0}, {1.5f, 0, 0}, {0, 1.5f, 0}});
    sample.update();
    REQUIRE(sample.skin().edited.size() == 2);
    const std::uint32_t vertex = sample.skin().edited[1];
    CHECK(sample.skin().field[vertex][0] == Vec3(1.5f, 0, 0));
    int others = 0;
    for (std::size_t v = 0; v < field.size(); ++v) {
        others += v != vertex && sample.skin().field[v] != field[v] ? 1 : 0;
    }
    CHECK(others == 0);
    CHECK(sample.growth_hash() == grown);

    furrows.hold.spread = furrows.arrows;
    sample.update();
    CHECK(sample.skin().field != field);
    CHECK(sample.growth_hash() == grown);

    furrows.hold.grown = furrows.hold.spread;
    sample.update();
    CHECK(sample.growth_hash() != grown);
}

TEST_CASE(
    "furrow skin: in the overview the images show smooth skin"
    * technique("wrinkle.furrow.view-modes")) {
    Sample sample;
    sample.world.add(sample.entity, FurrowView{.mode = FurrowMode::Overview});
    sample.update();
    const auto is_flat = [&] {
        const std::vector<std::uint8_t>& pixels = sample.skin().normals;
        for (std::size_t i = 0; i < pixels.size(); i += 4) {
            if (pixels[i] != 128 || pixels[i + 1] != 128 || pixels[i + 2] != 255) {
                return false;
            }
        }
        return true;
    };
    CHECK(is_flat());
    sample.world.get<FurrowView>(sample.entity).mode = FurrowMode::Wrinkles;
    sample.update();
    CHECK_FALSE(is_flat());
}

TEST_CASE(
    "furrow skin: images and meshes that do not fit grow nothing, with a reason"
    * technique("wrinkle.furrow.editor")) {
    struct Case {
        const char* expected;
        void (*spoil)(Sample&);
    };
    const Case cases[] = {
        {"no image", [](Sample& s) { s.furrows().normals = {}; }},
        {"96 x 64 px", [](Sample& s) { s.world.resource<Assets>().images[0].height = 64; }},
        {"sRGB", [](Sample& s) { s.world.resource<Assets>().images[0].srgb = true; }},
        {"a square of 96 px",
         [](Sample& s) { s.world.resource<Assets>().images[1] = blank_image(32); }},
        {"0 texture coordinates",
         [](Sample& s) { s.world.resource<Assets>().meshes[0].uvs.clear(); }},
        {"no triangle with an area",
         [](Sample& s) {
             auto& uvs = s.world.resource<Assets>().meshes[0].uvs;
             std::ranges::fill(uvs, Vec2(0.5f));
         }},
    };
    for (const Case& it : cases) {
        Sample sample;
        it.spoil(sample);
        ++sample.world.resource<Assets>().meshes[0].version;
        sample.update();
        CAPTURE(it.expected);
        CAPTURE(sample.skin().fault);
        CHECK(sample.skin().fault.find(it.expected) != std::string::npos);
        CHECK(sample.skin().version == 2);
        sample.update();  // logs it once
        CHECK(sample.skin().version == 2);
    }
}

}  // namespace limn::test::furrow_skin_test
