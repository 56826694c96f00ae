// Fields that are set by their path, as by --set.

#include "content/load/level/set_value.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/post.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/field_watch.h"
#include "ecs/world.h"
#include "tests/content/level_text.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

namespace limn::set_value_test {
namespace {

using test::find_named;
using test::named;
using test::spawn_into;

}  // namespace

TEST_CASE(
    "set: one field of an entity, a resource or a material changes"
    * technique("engine.param-access")) {
    World world;
    spawn_into(world, R"({
        "materials": {"gold": {}, "v1.2 brass": {}},
        "entities": [{"name": "lamp", "point_light": {}}, {"name": "twin", "spin": {}},
                     {"name": "eye", "orbit_camera": {}, "camera_path": {"keys": [{}, {"time": 1}]}}]})");
    world.insert_resource(Exposure{});
    CHECK(set_value(world, "lamp.point_light.intensity", "3.5").ok());
    CHECK(set_value(world, "lamp.point_light.color", "#ff0000").ok());
    CHECK(set_value(world, "lamp.point_light.attenuation.falloff", "smooth").ok());
    CHECK(set_value(world, "lamp.transform.position", "[1, 2, 3]").ok());
    CHECK(set_value(world, "eye.orbit_camera.target", "lamp").ok());
    CHECK(set_value(world, "eye.camera_path.keys.1.time", "4").ok());
    CHECK(set_value(world, "exposure.ev", " -2 ").ok());
    CHECK(set_value(world, "materials.gold.roughness", "0.125").ok());
    CHECK(world.resource<Assets>().material_version == 2);  // so that the renderer sees it
    CHECK(set_value(world, "materials.v1.2 brass.roughness", "0.25").ok());
    const PointLight& light = named<PointLight>(world, "lamp");
    CHECK(light.intensity == 3.5f);
    CHECK(light.color == Vec3(1, 0, 0));
    CHECK(light.attenuation.falloff == Falloff::Smooth);
    CHECK(named<Transform>(world, "lamp").position == Vec3(1, 2, 3));
    CHECK(named<OrbitCamera>(world, "eye").target == find_named(world, "lamp"));
    CHECK(named<CameraPath>(world, "eye").keys[1].time == 4.0f);
    CHECK(world.resource<Exposure>().ev == -2.0f);
    CHECK(world.resource<Assets>().materials[0].roughness == 0.125f);
    CHECK(world.resource<Assets>().materials[1].roughness == 0.25f);
    CHECK(set_value(world, "eye.camera_path.keys", "[]").ok());
    CHECK(named<CameraPath>(world, "eye").keys.empty());
    CHECK(set_value(world, "eye.camera_path.keys", R"([{"time": 2}])").ok());
    CHECK(named<CameraPath>(world, "eye").keys.size() == 1);
}

TEST_CASE("set: a resource that the scene lacks is created with defaults") {
    World world;
    spawn_into(world, R"({"entities": []})");
    CHECK(set_value(world, "exposure.ev", "-2").ok());
    REQUIRE(world.find_resource<Exposure>() != nullptr);
    CHECK(world.resource<Exposure>() == Exposure{.ev = -2});
}

TEST_CASE("set: a component that the entity lacks is added, with its defaults and a warning") {
    World world;
    spawn_into(world, R"({"entities": [{"name": "lamp"}]})");
    const std::vector<std::string> messages = test::messages_of(
        [&] { CHECK(set_value(world, "lamp.point_light.intensity", "3.5").ok()); });
    CHECK(named<PointLight>(world, "lamp").intensity == 3.5f);
    CHECK(named<PointLight>(world, "lamp").radius == PointLight{}.radius);
    REQUIRE(messages.size() == 1);
    CHECK(
        messages[0]
        == "--set lamp.point_light.intensity: the entity has no point_light; it is added with "
           "defaults");
}

TEST_CASE(
    "set: names may contain dots; the longest match is used" * technique("engine.param-access")) {
    World world;
    spawn_into(world, R"({"materials": {"gold": {}, "gold.001": {}}})");
    const Entity bone = world.create(Name{"Bone"}, PointLight{});
    const Entity other = world.create(Name{"Bone.001"}, PointLight{});
    CHECK(set_value(world, "Bone.001.point_light.attenuation.linear", "2").ok());
    CHECK(set_value(world, "Bone.point_light.intensity", "3").ok());
    CHECK(world.get<const PointLight>(bone).intensity == 3.0f);
    CHECK(world.get<const PointLight>(bone).attenuation.linear == 0.0f);
    CHECK(world.get<const PointLight>(other).attenuation.linear == 2.0f);
    CHECK(set_value(world, "materials.gold.001.roughness", "0.125").ok());
    CHECK(world.resource<Assets>().materials[1].roughness == 0.125f);
    CHECK(world.resource<Assets>().materials[0].roughness == Material{}.roughness);
}

TEST_CASE(
    "set: what cannot be set is named, and nothing changes" * technique("engine.param-access")) {
    World world;
    spawn_into(
        world, R"({"materials": {"gold": {}}, "entities": [{"name": "lamp", "point_light": {}}]})");
    const std::pair<const char*, const char*> bad[] = {
        {"lamp.point_light.intensity", "-1"},
        {"lamp.point_light.intensity", "bright"},
        {"lamp.point_light.intensty", "1"},
        {"lamp.point_lihgt.intensity", "1"},
        {"lamp.spot_light.intensity", "-1"},
        {"lamp.transform.scale", "[1, 0, 1]"},
        {"lmap.point_light.intensity", "1"},
        {"lamp.point_light", "1"},
        {"lamp", "1"},
        {"", "1"},
        {".", "1"},
        {"materials.gold.rough", "1"},
        {"materials.silver.roughness", "1"},
        {"materials.gold", "1"},
        {"exposure.ev", "100"},
        {"exposure.evv", "1"}};
    for (const std::pair<const char*, const char*>& assignment : bad) {
        CAPTURE(assignment.first);
        const Status status = set_value(world, assignment.first, assignment.second);
        REQUIRE_FALSE(status.ok());
        CHECK(status.error().message.starts_with("--set "));
        CHECK(status.error().message.find('\n') == std::string::npos);
    }
    CHECK(named<PointLight>(world, "lamp").intensity == PointLight{}.intensity);
    CHECK_FALSE(world.has<SpotLight>(find_named(world, "lamp")));
    CHECK(world.find_resource<Exposure>() == nullptr);
    CHECK(set_value(world, "lmap.point_light.intensity", "1")
              .error()
              .message.ends_with("(did you mean lamp?)"));
    CHECK(set_value(world, "lamp.point_light.intensty", "1")
              .error()
              .message.ends_with("(did you mean intensity?)"));
    (void)world.create(Name{"Bone.001"}, PointLight{});
    const auto error_of = [&](const char* path) {
        const Status status = set_value(world, path, "1");
        REQUIRE_FALSE(status.ok());
        return status.error().message;
    };
    CHECK(
        error_of("Bone.002.point_light.intensity")
        == "--set Bone.002.point_light.intensity: found \"Bone.002\", expected an entity, a "
           "resource "
           "or materials before a dot (did you mean Bone.001?)");
    CHECK(
        error_of("house.point_light.intensity")
        == "--set house.point_light.intensity: found \"house\", expected an entity, a resource or "
           "materials before a dot");
    CHECK(
        error_of("Bone.001")
        == "--set Bone.001: found no component, expected ENTITY.COMPONENT.FIELD");
}

TEST_CASE("set: of several entities of one name all change, or none") {
    World world;
    spawn_into(world, "{}");
    const Entity wide =
        world.create(Name{"lamp"}, SpotLight{.inner_angle = 0.1f, .outer_angle = 1});
    const Entity narrow =
        world.create(Name{"lamp"}, SpotLight{.inner_angle = 0.1f, .outer_angle = 0.3f});
    CHECK_FALSE(set_value(world, "lamp.spot_light.inner_angle", "0.5").ok());
    CHECK(world.get<const SpotLight>(wide).inner_angle == 0.1f);
    CHECK(set_value(world, "lamp.spot_light.inner_angle", "0.2").ok());
    CHECK(world.get<const SpotLight>(wide).inner_angle == 0.2f);
    CHECK(world.get<const SpotLight>(narrow).inner_angle == 0.2f);
}

TEST_CASE("set: handlers are called once before and after, and not for a value that is refused") {
    World world;
    spawn_into(world, R"({"entities": [{"name": "lamp", "point_light": {"intensity": 2}}]})");
    std::vector<float> seen;
    watch_field<PointLight>(world, "intensity", [&](World& there, const FieldNote& note) {
        seen.push_back(std::as_const(there).get<PointLight>(note.entity).intensity);
    });
    for (const char* const refused : {"-1", "bright", "[1, 2]", "1e999"}) {
        CHECK_FALSE(set_value(world, "lamp.point_light.intensity", refused).ok());
    }
    CHECK(seen.empty());
    CHECK(set_value(world, "lamp.point_light.intensity", "3").ok());
    CHECK(seen == std::vector<float>{2, 3});
}

}  // namespace limn::set_value_test
