// Prefabs and names of a level: who is copied, and whom a name refers to.

#include "ecs/components/camera.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/content/level_text.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::level_prefab_test {
namespace {

using test::find_named;
using test::named;
using test::spawn_into;

}  // namespace

TEST_CASE(
    "level: prefabs are copied with their children, changed and extended by their users"
    * technique("engine.stock-active")) {
    World world;
    spawn_into(world, R"({
        "prefabs": {
            "lamp": {"transform": {"scale": [2, 2, 2]}, "spin": {"speed": 3},
                     "point_light": {"intensity": 5, "radius": 4},
                     "children": [{"name": "bulb", "transform": {"position": [0, 1, 0]}}]},
            "tall lamp": {"prefab": "lamp", "point_light": {"radius": 9}}},
        "entities": [
            {"name": "a", "prefab": "lamp"},
            {"name": "b", "prefab": "tall lamp", "transform": {"position": [7, 0, 0]}, "spin": null,
             "point_light": {"intensity": 6}, "children": [{"name": "shade"}]}]
    })");
    CHECK(named<PointLight>(world, "a").intensity == 5.0f);
    CHECK(named<Spin>(world, "a").speed == 3.0f);
    CHECK(named<PointLight>(world, "b").intensity == 6.0f);
    CHECK(named<PointLight>(world, "b").radius == 9.0f);
    CHECK(named<Transform>(world, "b").position == Vec3(7, 0, 0));
    CHECK(named<Transform>(world, "b").scale == Vec3(2));
    CHECK(world.find<Spin>(find_named(world, "b")) == nullptr);
    const auto names_below = [&](const char* name) {
        std::vector<std::string> names;
        for (const Entity child : children_of(world, find_named(world, name))) {
            names.push_back(world.get<const Name>(child).text);
        }
        return names;
    };
    CHECK(names_below("a") == std::vector<std::string>{"bulb"});
    CHECK(names_below("b") == std::vector<std::string>{"bulb", "shade"});
}

TEST_CASE(
    "level: the book's scene of nine objects, of which three are used twice, has twelve"
    * technique("engine.stock-active")) {
    World world;
    spawn_into(world, R"({
        "prefabs": {"engine": {"children": [
            {"name": "fire", "particle_emitter": {"rate": 25}, "children": [{"name": "spark"}]}]}},
        "entities": [{"name": "scene", "children": [
            {"name": "panorama"}, {"name": "dust"},
            {"name": "catfish", "children": [
                {"name": "right", "children": [{"prefab": "engine"}]},
                {"name": "left", "children": [{"prefab": "engine"}]}]}]}]
    })");
    CHECK(world.entity_count() == 12);
    std::vector<Entity> fires;
    world.query<const Name>().each([&](Entity entity, const Name& name) {
        if (name.text == "fire") {
            fires.push_back(entity);
        }
    });
    REQUIRE(fires.size() == 2);
    world.get<ParticleEmitter>(fires[0]).rate = 50;
    CHECK(world.get<const ParticleEmitter>(fires[1]).rate == 25.0f);
}

TEST_CASE(
    "level: names refer to the copy's own entity first, and may be used before their definition") {
    World world;
    spawn_into(world, R"({
        "prefabs": {"rig": {"orbit_camera": {"target": "focus"},
                            "children": [{"name": "focus"}, {"name": "eye", "orbit_camera": {"target": "sun"}}]}},
        "entities": [
            {"name": "first", "prefab": "rig"},
            {"name": "second", "prefab": "rig"},
            {"name": "third", "orbit_camera": {"target": "second"}},
            {"name": "sun"}]
    })");
    for (const char* rig : {"first", "second"}) {
        const Entity root = find_named(world, rig);
        const Entity target = named<OrbitCamera>(world, rig).target;
        CHECK(parent_of(world, target) == root);
        CHECK(world.get<const Name>(target).text == "focus");
        CHECK(
            world.get<const OrbitCamera>(children_of(world, root)[1]).target
            == find_named(world, "sun"));
    }
    CHECK(named<OrbitCamera>(world, "third").target == find_named(world, "second"));
}

TEST_CASE("level: a prefab inside a prefab resolves the names around it") {
    World world;
    spawn_into(world, R"({
        "prefabs": {"eye": {"orbit_camera": {"target": "head"}, "children": [{"name": "lid"}]},
                    "body": {"children": [{"name": "head"}, {"name": "left eye", "prefab": "eye"}]}},
        "entities": [{"name": "head"}, {"name": "one", "prefab": "body"}]})");
    const Entity target = named<OrbitCamera>(world, "left eye").target;
    CHECK(parent_of(world, target) == find_named(world, "one"));
}

}  // namespace limn::level_prefab_test
