// Copies of an entity: where `repeat` places them, and how `vary` makes them differ.

#include "ecs/components/light.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/content/level_text.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace limn::level_repeat_test {
namespace {

using test::find_named;
using test::named;
using test::parse;
using test::spawn_into;

Sway sway_named(const World& world, std::string_view name) {
    return world.value<Sway>(find_named(world, name));
}

}  // namespace

TEST_CASE("level: a sway without a center swings about its entity's position") {
    World world;
    spawn_into(world, R"({"entities": [
        {"name": "a", "transform": {"position": [1, 2, 3]}, "sway": {}},
        {"name": "b", "transform": {"position": [1, 2, 3]}, "sway": {"center": [0, 0, 0]}},
        {"name": "c", "transform": {"position": [1, 0, 0]}, "sway": {},
         "repeat": {"count": [2, 1, 1], "spacing": [10, 0, 0], "centered": false}}]})");
    CHECK(sway_named(world, "a").center == Vec3(1, 2, 3));
    CHECK(sway_named(world, "b").center == Vec3(0));
    CHECK(sway_named(world, "c[1]").center == Vec3(11, 0, 0));
}

TEST_CASE("level: a grid is centered and evenly spaced, x running fastest") {
    const Level level = parse(R"({"entities": [
        {"name": "g", "transform": {"position": [0, 5, 0]},
         "repeat": {"count": [3, 1, 2], "spacing": [2, 1, 4]}}]})");
    World world;
    const std::vector<Entity> entities = spawn_level(world, level);
    REQUIRE(entities.size() == 6);
    const auto place = [&](int i) {
        return named<Transform>(world, "g[" + std::to_string(i) + "]").position;
    };
    CHECK(place(0) == Vec3(-2, 5, -2));
    CHECK(place(1) == Vec3(0, 5, -2));
    CHECK(place(5) == Vec3(2, 5, 2));
}

TEST_CASE("level: a ring turns its copies with it") {
    World world;
    spawn_into(
        world, R"({"entities": [{"name": "r", "repeat": {"count": [4, 1, 1], "radius": 3}}]})");
    for (int i = 0; i < 4; ++i) {
        const Transform& t = named<Transform>(world, "r[" + std::to_string(i) + "]");
        CHECK(glm::length(t.position) == test::near(3.0f));
        const Vec3 ahead = t.rotation * Vec3(0, 0, -1);
        CHECK(glm::length(t.position + 3.0f * ahead) < 1e-5f);  // toward the middle
    }
}

TEST_CASE(
    "level: copies vary as specified: interpolated, picked, at random, and the same every time") {
    constexpr const char* kText = R"({
        "materials": {"red": {}, "green": {}, "blue": {}},
        "entities": [{"name": "v", "point_light": {}, "mesh_instance": {}, "sway": {}, "transform": {},
         "repeat": {"count": [5, 1, 1], "seed": 4, "jitter": [0.5, 0, 0], "spacing": [2, 0, 0], "vary": {
            "point_light.intensity": {"by": "x", "from": 1, "to": 3},
            "point_light.color": {"from": [0, 0, 0], "to": "#ffffff"},
            "mesh_instance.material": {"by": "x", "pick": ["red", "green", "blue"]},
            "transform.rotation": {"by": "index", "from": [0, 0, 0], "to": [90, 0, 0]},
            "sway.phase": {"from": [0, 0, 0], "to": [6, 6, 6]}}}}]})";
    World world;
    spawn_into(world, kText);
    World again;
    spawn_into(again, kText);
    const Assets& assets = world.resource<Assets>();
    std::set<float> phases;
    for (int i = 0; i < 5; ++i) {
        const std::string name = "v[" + std::to_string(i) + "]";
        const PointLight& light = named<PointLight>(world, name);
        CHECK(light.intensity == test::near(1.0f + 0.5f * static_cast<float>(i)));
        CHECK(light.color.x == light.color.y);  // a color is one number
        const Sway sway = sway_named(world, name);
        CHECK(sway.phase.x != sway.phase.y);  // a vector is one a lane
        CHECK(sway.phase.x >= 0.0f);
        CHECK(sway.phase.x <= 6.0f);
        phases.insert(sway.phase.x);
        const Transform& transform = named<Transform>(world, name);
        const float moved = std::abs(transform.position.x - 2.0f * static_cast<float>(i - 2));
        CHECK(moved <= 0.5f);
        CHECK(moved > 0.0f);
        CHECK(sway.center == transform.position);
        CHECK(sway_named(again, name).phase == sway.phase);
        CHECK(named<Transform>(again, name).position == transform.position);
    }
    CHECK(phases.size() == 5);
    const auto material = [&](int i) {
        return assets
            .materials[named<MeshInstance>(world, "v[" + std::to_string(i) + "]").material.index]
            .name;
    };
    CHECK(material(0) == "red");
    CHECK(material(2) == "green");
    CHECK(material(4) == "blue");
    const Vec3 turned = named<Transform>(world, "v[4]").rotation * Vec3(0, 0, -1);
    CHECK(turned.x == test::near(-1.0f));
}

TEST_CASE("level: numbers by radius, angle and with times cover their range") {
    World world;
    spawn_into(world, R"({"entities": [{"point_light": {}, "spot_light": {}, "spin": {},
        "repeat": {"count": [9, 1, 9], "vary": {
            "point_light.intensity": {"by": "radius", "from": 0, "to": 1},
            "point_light.radius": {"by": "angle", "from": 0, "to": 1},
            "spin.speed": {"by": "x", "from": 0, "to": 1, "times": 4}}}}]})");
    float most = 0;
    float least = 1;
    world.query<const Transform, const PointLight, const Spin>().each(
        [&](const Transform& t, const PointLight& light, const Spin& spin) {
            const float expected = glm::length(t.position) / glm::length(Vec3(4, 0, 4));
            CHECK(light.intensity == test::near(expected));
            CHECK(light.radius >= 0.0f);
            CHECK(light.radius <= 1.0f);
            const float turns = 4.0f * (t.position.x + 4.0f) / 8.0f;
            CHECK(spin.speed == test::near(turns - std::floor(turns)));
            most = std::max(most, light.intensity);
            least = std::min(least, light.intensity);
        });
    CHECK(most == test::near(1.0f));
    CHECK(least == 0.0f);
}

TEST_CASE("level: noise blurs where one item of a pick ends and the next begins") {
    const auto count_strays = [](const char* noise) {
        World world;
        spawn_into(
            world, std::string(R"({"entities": [{"point_light": {}, "repeat": {"count": [200, 1, 1],
            "vary": {"point_light.intensity": {"by": "x", "pick": [1, 2], "noise": )")
                       + noise + "}}}}]}");
        int strays = 0;
        world.query<const Transform, const PointLight>().each(
            [&](const Transform& t, const PointLight& light) {
                strays += (t.position.x < 0) != (light.intensity == 1.0f) ? 1 : 0;
            });
        return strays;
    };
    CHECK(count_strays("0") == 0);
    CHECK(count_strays("0.2") > 4);
    CHECK(count_strays("0.2") < 40);
}

TEST_CASE(
    "level: a user of a repeated prefab may override single keys of its repeat, or disable it") {
    World world;
    spawn_into(world, R"({
        "prefabs": {"row": {"repeat": {"count": [3, 1, 1], "spacing": [2, 0, 0], "jitter": [0.1, 0, 0], "seed": 1}}},
        "entities": [{"name": "a", "prefab": "row"}, {"name": "b", "prefab": "row", "repeat": {"seed": 2}},
                     {"name": "c", "prefab": "row", "repeat": {"count": [2, 1, 1], "jitter": [0, 0, 0]}},
                     {"name": "d", "prefab": "row", "repeat": null}]})");
    CHECK(named<Transform>(world, "a[2]").position != named<Transform>(world, "b[2]").position);
    CHECK(named<Transform>(world, "b[2]").position.x == test::near(2.0f).epsilon(0.1));
    CHECK(named<Transform>(world, "c[1]").position == Vec3(1, 0, 0));
    CHECK(named<Transform>(world, "d").position == Vec3(0));
    CHECK(world.entity_count() == 3 + 3 + 2 + 1);
}

TEST_CASE("level: repeated entities keep their children, and repetitions multiply") {
    World world;
    spawn_into(world, R"({"entities": [{"name": "row", "repeat": {"count": [3, 1, 1]}, "children": [
        {"name": "post", "repeat": {"count": [2, 1, 1]}, "children": [{"point_light": {}}]}]}]})");
    CHECK(world.query<const PointLight>().count() == 6);
    CHECK(world.query<const Transform>().count() == 3 + 6 + 6);
    CHECK(children_of(world, find_named(world, "row[2]")).size() == 2);
}

TEST_CASE("level: a hundred thousand boxes are a few lines, and one batch") {
    World world;
    spawn_into(world, R"({
        "materials": {"a": {}, "b": {}}, "meshes": {"box": {"make": "box"}},
        "prefabs": {"box": {"mesh_instance": {"mesh": "box", "material": "a"}, "spin": {}, "sway": {}}},
        "entities": [{"prefab": "box", "repeat": {"count": [400, 1, 250], "vary": {
            "mesh_instance.material": {"pick": ["a", "b"]}, "sway.phase": {"by": "x", "from": [0, 0, 0], "to": [0, 9, 0]}}}}]})");
    CHECK(
        world.query<const MeshInstance, const Spin, const Sway, const Transform>().count()
        == 100'000);
    int used = 0;
    for (const auto& archetype : world.archetypes()) {
        used += archetype->size() > 0 ? 1 : 0;
    }
    CHECK(used == 1);
}

}  // namespace limn::level_repeat_test
