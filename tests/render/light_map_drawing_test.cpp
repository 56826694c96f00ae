#include "ecs/components/light_map.h"
#include "systems/light/light_map_charts.h"
#include "systems/light/light_map_system.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <utility>

// Light maps as they are drawn, against lights themselves.

namespace limn::test::light_map_drawing_test {
namespace {

/// A matte square under a lamp, a spot light and a sun.
struct LightMapScene : Scene {
    Entity square;

    LightMapScene() {
        square = place(add(make_square()), add(matte()), at({0, 0, 0}));
        world.insert_resource(LightMapOccluders{});
        const Attenuation polynomial = {.falloff = Falloff::Polynomial, .quadratic = 2};
        shine(
            PointLight{
                .color = {1, 0.5f, 0.2f},
                .intensity = 1.5f,
                .radius = 2,
                .attenuation = polynomial},
            at({0.4f, 0.3f, 0.7f}));
        shine(
            SpotLight{.color = {0.3f, 0.6f, 1}, .intensity = 3, .radius = 4, .inner_angle = 0.2f},
            look_at({-0.5f, -0.2f, 1.2f}, {-0.4f, -0.1f, 0}));
        shine(DirectionalLight{.illuminance = 0.4f}, look_at({0, 0, 0}, {0.5f, 0.2f, -1}));
    }
    static Material matte() {
        return {
            .shading = ShadingModel::Blinn,
            .base_color = {0.8f, 0.7f, 0.5f, 1},
            .specular = {0, 0, 0}};
    }
    gpu::FloatImage image() { return radiance(look({0, 0, 1}, {0, 0, 0})); }

    std::vector<Entity> lights() {
        std::vector<Entity> all;
        for (const auto& found :
             {list<PointLight>(), list<SpotLight>(), list<DirectionalLight>()}) {
            all.insert(all.end(), found.begin(), found.end());
        }
        return all;
    }
    void bake() {
        world.run(add_light_map_states);
        world.run(update_light_maps);
    }

  private:
    template <typename Light>
    std::vector<Entity> list() {
        std::vector<Entity> found;
        world.query<const Light>().each(
            [&](Entity entity, const Light&) { found.push_back(entity); });
        return found;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    LightMapScene, "light map: a surface looks as by the lights themselves, to 2 % of the brightest"
                       * technique("light.lightmap")) {
    const gpu::FloatImage lit = image();
    const float brightest = *std::max_element(lit.pixels.begin(), lit.pixels.end());
    REQUIRE(brightest > 0.5f);
    for (const Entity light : lights()) {
        world.add(light, BakedLight{});
    }
    CHECK(rgb_at(image(), 32, 32) == Vec3(0));  // no light map yet
    world.add(square, LightMap{.density = 48, .shadows = false});
    bake();
    const gpu::FloatImage mapped = image();
    // The cone of the spot light ends within a few texels.
    CHECK(largest_difference(mapped, lit) < 0.02f * brightest);
    world.get<LightMap>(square).density = 2;  // of maps that are made
    CHECK(largest_difference(image(), mapped) == 0);
}

TEST_CASE_FIXTURE(
    LightMapScene, "light map: when a stored light moves, the image is that of the new place"
                       * technique("light.lightmap")) {
    for (const Entity light : lights()) {
        world.add(light, BakedLight{});
    }
    world.add(square, LightMap{.density = 48, .shadows = false});
    bake();
    const gpu::FloatImage before = image();
    for (const Entity light : lights()) {
        if (world.has<PointLight>(light)) {
            world.get<WorldTransform>(light).world = at({-0.6f, 0.5f, 0.6f});
        }
    }
    bake();
    const gpu::FloatImage after = image();
    CHECK(largest_difference(before, after) > 0.1f);
    for (const Entity light : lights()) {
        world.remove<BakedLight>(light);
    }
    bake();  // nothing is stored any more
    const gpu::FloatImage lit = image();
    const float brightest = *std::max_element(lit.pixels.begin(), lit.pixels.end());
    CHECK(largest_difference(after, lit) < 0.02f * brightest);
}

TEST_CASE_FIXTURE(
    LightMapScene,
    "light map: metal has no diffuse light, stored or not" * technique("light.lightmap")) {
    for (const Entity light : lights()) {
        world.add(light, BakedLight{});
    }
    auto& assets = world.resource<Assets>();
    const std::uint32_t material = world.get<MeshInstance>(square).material.index;
    assets.materials[material] = {.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = 0.5f};
    ++assets.material_version;
    world.add(square, LightMap{});
    bake();
    CHECK(rgb_at(image(), 32, 32) == Vec3(0));
}

}  // namespace limn::test::light_map_drawing_test
