#include "content/game/game.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/level/level_load.h"
#include "content/load/level/level_schema.h"
#include "content/load/level/set_value.h"
#include "content/load/scene_load.h"
#include "ecs/base/log.h"
#include "ecs/components/all.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/post.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace limn::level_test {
namespace {

Level parse(std::string_view text) {
    register_all_components();
    Result<Level> level = parse_level(text, "t.level.json");
    REQUIRE_MESSAGE(level.ok(), (level.ok() ? "" : level.error().message));
    return *std::move(level);
}

/// The level in a world, its assets made.
void spawn_into(World& world, std::string_view text) {
    Level level = parse(text);
    const Status status = load_level_assets(level, "");
    REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : status.error().message));
    (void)spawn_level(world, std::move(level));
}

Entity find_named(const World& world, std::string_view name) {
    Entity found;
    world.query<const Name>().each([&](Entity entity, const Name& candidate) {
        found = candidate.text == name ? entity : found;
    });
    REQUIRE_MESSAGE(!found.is_null(), name);
    return found;
}

template <typename T>
const T& named(const World& world, std::string_view name) {
    return world.get<T>(find_named(world, name));
}
Sway sway_named(const World& world, std::string_view name) {
    return world.value<Sway>(find_named(world, name));
}

}  // namespace

TEST_CASE("level: an empty one is a level") {
    const Level level = parse("{}");
    CHECK(level.name == "t");
    CHECK(level.entities.entities.empty());
    World world;
    CHECK(spawn_level(world, level).empty());
}

TEST_CASE("level: resources, materials, meshes and entities arrive in the world as written") {
    World world;
    spawn_into(world, R"({
        "title": "A test",
        "resources": {"exposure": {"ev": 2}, "random_seed": {"seed": 9}, "frame_time": {"step": 0.01}},
        "materials": {
            "gold": {"base_color": "#ff8000", "metalness": 1, "roughness": 0.2},
            "dull": {"like": "gold", "roughness": 0.9}},
        "meshes": {"ball": {"make": "sphere", "radius": 2, "segments": 8, "rings": 4}},
        "entities": [
            {"name": "one", "transform": {"position": [1, 2, 3]},
             "mesh_instance": {"mesh": "ball", "material": "dull"}},
            {"point_light": {"intensity": 7}}]
    })");
    CHECK(world.resource<Exposure>().ev == 2.0f);
    CHECK(world.resource<RandomSeed>().seed == 9);
    CHECK(world.resource<FrameTime>().step == 0.01f);
    const Assets& assets = world.resource<Assets>();
    const MeshInstance& instance = named<MeshInstance>(world, "one");
    CHECK(assets.meshes[instance.mesh.index].name == "ball");
    CHECK(assets.meshes[instance.mesh.index].bounds.max.y == test::near(2.0f));
    const Material& dull = assets.materials[instance.material.index];
    CHECK(dull.name == "dull");
    CHECK(dull.metalness == 1.0f);
    CHECK(dull.roughness == 0.9f);
    CHECK(dull.base_color.y == test::near(0.2158605f));
    CHECK(named<Transform>(world, "one").position == Vec3(1, 2, 3));
    CHECK(world.query<const PointLight, const Transform>().count() == 1);  // every entity has one
}

TEST_CASE("level: a pattern gives a material all its maps, tiled") {
    World world;
    spawn_into(world, R"({
        "images": {"floor": {"make": "marble", "size": 8}},
        "materials": {"m": {"pattern": "floor", "tiling": [4, 2], "normal_scale": 0.5},
                      "n": {"base_color_texture": {"image": "floor.base_color"}}}
    })");
    const Assets& assets = world.resource<Assets>();
    REQUIRE(assets.images.size() == 3);
    CHECK(assets.images[0].name == "floor.base_color");
    CHECK(assets.images[0].width == 8);
    CHECK(assets.images[0].srgb);
    CHECK_FALSE(assets.images[2].srgb);
    const Material& m = assets.materials[0];
    CHECK(m.base_color == Vec4(1));
    CHECK(m.roughness == 1.0f);
    CHECK(m.metalness == 1.0f);
    CHECK(m.normal_texture.image.index == 1);
    CHECK(m.metal_rough_texture.image.index == 2);
    CHECK(m.occlusion_texture.image.index == 2);
    CHECK(m.occlusion_texture.scale == Vec2(4, 2));
    CHECK(m.normal_scale == 0.5f);
    CHECK(assets.materials[1].base_color_texture.image.index == 0);
}

TEST_CASE("level: a panorama is one of its images, and what is not finite in that is replaced") {
    const test::TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const bool half : {false, true}) {
        ExrImage exr{.width = 4, .height = 2};
        std::vector<float> values(24, 0.5f);
        values[3] = nan;
        values[4] = INFINITY;
        values[5] = -INFINITY;
        add_layer(exr, "", "RGB", values, half);
        REQUIRE(write_exr(folder.file("sky.exr"), exr).ok());
        static int warnings;
        warnings = 0;
        set_log_sink([](LogLevel level, std::string_view message) {
            const bool expected = message.find("sky.exr: 3 values are not finite") != message.npos;
            warnings += level == LogLevel::Warn && expected ? 1 : 0;
        });
        Level level = parse(R"({
            "images": {"marble": {"make": "marble", "size": 4}, "sky": {"file": "sky.exr"}},
            "resources": {"environment": {"sky": "panorama", "panorama": "sky", "rotation": 1}}})");
        const Status loaded = load_level_assets(level, folder.path());
        set_log_sink(nullptr);
        REQUIRE(loaded.ok());
        CHECK(warnings == 1);
        World world;
        world.insert_resource(Assets{});
        world.resource<Assets>().images.emplace_back();
        spawn_level(world, std::move(level));
        const auto& environment = world.resource<Environment>();
        CHECK(environment.sky == SkyKind::Panorama);
        CHECK(environment.panorama.index == 4);  // behind the world's and the marble's
        const ImageData& image = world.resource<Assets>().images[4];
        CHECK(image.format == (half ? PixelFormat::Rgba16F : PixelFormat::Rgba32F));
        ImageData again = image;
        CHECK(replace_non_finite(again) == 0);
        if (!half) {
            std::vector<float> pixels(32);
            std::memcpy(pixels.data(), image.pixels.data(), image.pixels.size());
            CHECK(pixels[4] == 0);
            CHECK(pixels[5] == 65504);
            CHECK(pixels[6] == -65504);
            CHECK(pixels[7] == 1);  // alpha
            CHECK(pixels[8] == 0.5f);
        }
    }
}

TEST_CASE("level: a second one stands behind the assets of the first") {
    constexpr const char* kText = R"({
        "images": {"p": {"make": "checker", "size": 4}},
        "materials": {"m": {"pattern": "p"}}, "meshes": {"b": {"make": "box"}},
        "entities": [{"mesh_instance": {"mesh": "b", "material": "m"}}],
        "events": [{"at": 1, "spawn": [{"mesh_instance": {"mesh": "b", "material": "m"}}]}]})";
    World world;
    spawn_into(world, kText);
    spawn_into(world, kText);
    std::set<std::uint32_t> meshes;
    world.query<const MeshInstance>().each([&](const MeshInstance& instance) {
        CHECK(instance.mesh.index == instance.material.index);
        meshes.insert(instance.mesh.index);
    });
    CHECK(meshes == std::set<std::uint32_t>{0, 1});
    CHECK(world.resource<Assets>().materials[1].normal_texture.image.index == 4);
    const Prefab& spawned = world.resource<EventList>().events.at(0).actions.at(0).prefab;
    for (const AnyComponent& component : spawned.entities.at(0).components) {
        if (&component.info() == &component_info<MeshInstance>()) {
            CHECK(component.as<MeshInstance>().mesh.index == 1);
        }
    }
}

TEST_CASE("level: prefabs are copied with their children, changed and extended by their users") {
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

TEST_CASE("level: a camera with a path begins where the path does") {
    World world;
    spawn_into(world, R"({"entities": [{"name": "c", "camera": {}, "camera_path": {"keys": [
        {"time": 0, "position": [3, 1, 0], "look_at": [0, 1, 0]}, {"time": 2, "position": [0, 1, 3]}]}}]})");
    const Transform& t = named<Transform>(world, "c");
    CHECK(t.position == Vec3(3, 1, 0));
    CHECK((t.rotation * Vec3(0, 0, -1)).x == test::near(-1.0f));
}

TEST_CASE("level: events name entities, resources and what they spawn") {
    World world;
    spawn_into(world, R"({
        "entities": [{"name": "lamp", "point_light": {}}, {"name": "target"}],
        "prefabs": {"stone": {"orbit_camera": {"target": "target"}, "children": [{"name": "chip"}]}},
        "events": [
            {"at": "500ms", "every": 0.25, "times": 4, "set": {"lamp": {"point_light": {"attenuation": {"linear": 2}}}},
             "set_resources": {"exposure": {"ev": -1}},
             "impulse": {"lamp": {"transform": {"position": [0, -1, 0]}, "point_light": {"intensity": -3}}},
             "spawn": [{"prefab": "stone"}], "destroy": ["target"],
             "impulse_resources": {"exposure": {"curve": -1}}},
            {"at": 1, "every": 1, "set": {"lamp": {"orbit_camera": {"target": "lamp"}}}}]})");
    const EventList& list = world.resource<EventList>();
    REQUIRE(list.events.size() == 2);
    const ScriptEvent& event = list.events[0];
    CHECK(event.time == 0.5);
    CHECK(event.times == 4);
    REQUIRE(event.actions.size() == 7);
    CHECK(event.actions[0].entity == find_named(world, "lamp"));
    CHECK(std::string(event.actions[0].edits.at(0).field->name) == "linear");
    CHECK(event.actions[1].is_resource);
    CHECK(event.actions[2].action == EventAction::Impulse);
    CHECK(event.actions[4].prefab.entities.size() == 2);
    for (const AnyComponent& component : event.actions[4].prefab.entities[0].components) {
        if (&component.info() == &component_info<OrbitCamera>()) {
            CHECK(component.as<OrbitCamera>().target == find_named(world, "target"));
        }
    }
    CHECK(event.actions[5].entity == find_named(world, "target"));
    CHECK(event.actions[6].is_resource);
    CHECK(event.actions[6].edits.at(0).steps == -1);
    CHECK(list.events[1].times > 1'000'000);  // without times: for ever
    CHECK(list.events[1].actions[0].value.as<OrbitCamera>().target == find_named(world, "lamp"));
}

TEST_CASE("level: files are found below its own folder, and glTF files share their meshes") {
    const std::optional<std::string> fox = test::shared_asset("gltf/Fox.glb");
    if (!fox) {
        return;
    }
    const test::TemporaryFolder folder;
    std::filesystem::copy_file(*fox, folder.file("fox.glb"));
    std::ofstream(folder.file("zoo.level.json"))
        << R"({"entities": [{"gltf": "fox.glb"}, {"gltf": "fox.glb", "transform": {"position": [9, 0, 0]}}]})";
    World world;
    const Result<LoadedScene> scene = load_scene(world, folder.file("zoo.level.json"));
    REQUIRE_MESSAGE(scene.ok(), (scene.ok() ? "" : scene.error().message));
    CHECK(scene->name == "zoo");
    CHECK(world.resource<Assets>().meshes.size() == 1);
    CHECK(world.query<const MeshInstance>().count() == 2);
}

TEST_CASE("scene: a glTF alone is framed and lit") {
    const std::optional<std::string> fox = test::shared_asset("gltf/Fox.glb");
    if (!fox) {
        return;
    }
    World world;
    const Result<LoadedScene> scene = load_scene(world, *fox);
    REQUIRE_MESSAGE(scene.ok(), (scene.ok() ? "" : scene.error().message));
    CHECK(scene->name == "Fox");
    REQUIRE(scene->model);
    CHECK(scene->camera == scene->model->camera);
    CHECK(world.alive(scene->camera));
    CHECK(center(scene->model->subject) == center(scene->bounds));
}

TEST_CASE("scene: seed and missing resources are filled in") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("bare.level.json")) << R"({"title": "Bare"})";
    World world;
    const Result<LoadedScene> scene =
        load_scene(world, folder.file("bare.level.json"), {.seed = 77});
    REQUIRE(scene.ok());
    CHECK(scene->title == "Bare");
    CHECK(world.alive(scene->camera));
    CHECK(world.resource<RandomSeed>().seed == 77);
    CHECK(world.find_resource<Assets>() != nullptr);
    CHECK(world.find_resource<EventList>() != nullptr);
    CHECK(is_empty(scene->bounds));
}

TEST_CASE("scene: bounds follow the hierarchy") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("b.level.json")) << R"({
        "materials": {"m": {}}, "meshes": {"box": {"make": "box"}},
        "entities": [{"transform": {"position": [10, 0, 0], "scale": [2, 2, 2]}, "children": [
            {"transform": {"position": [1, 0, 0]}, "mesh_instance": {"mesh": "box", "material": "m"}}]}]})";
    World world;
    const Result<LoadedScene> scene = load_scene(world, folder.file("b.level.json"));
    REQUIRE(scene.ok());
    CHECK(scene->bounds.min.x == test::near(11.0f));
    CHECK(scene->bounds.max.x == test::near(13.0f));
}

TEST_CASE("set: one field of an entity, a resource or a material changes") {
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

TEST_CASE("set: names may contain dots; the longest match is used") {
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

TEST_CASE("set: what cannot be set is named, and nothing changes") {
    World world;
    spawn_into(
        world, R"({"materials": {"gold": {}}, "entities": [{"name": "lamp", "point_light": {}}]})");
    const std::pair<const char*, const char*> bad[] = {
        {"lamp.point_light.intensity", "-1"},
        {"lamp.point_light.intensity", "bright"},
        {"lamp.point_light.intensty", "1"},
        {"lamp.point_lihgt.intensity", "1"},
        {"lamp.spot_light.intensity", "-1"},
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

TEST_CASE("level schema: it is JSON and knows every component with its ranges") {
    register_all_components();
    const JsonValue schema = level_schema();
    const Result<JsonValue> read = parse_json(write_json(schema), "schema");
    REQUIRE(read.ok());
    const JsonValue* const definitions = read->find("$defs");
    REQUIRE(definitions != nullptr);
    for (const ComponentInfo* info : all_components()) {
        CAPTURE(info->name);
        const JsonValue* const definition = definitions->find(info->name);
        REQUIRE(definition != nullptr);
        for (const FieldInfo& field : info->fields) {
            const JsonValue* const property = definition->find("properties")->find(field.name);
            REQUIRE(property != nullptr);
            CHECK(property->find("description") != nullptr);
            const bool has_fields =
                field.type == FieldType::Struct && field.shape == FieldShape::One;
            CHECK((property->find("default") != nullptr) != has_fields);
        }
    }
    const JsonValue* const intensity =
        definitions->find("point_light")->find("properties")->find("intensity")->find("anyOf");
    REQUIRE(intensity != nullptr);
    CHECK(schema["$defs"]["point_light"]["properties"]["intensity"]["default"].number == 10.0);
    CHECK(intensity->items[0].find("minimum")->number == 0.0);
    CHECK(intensity->items[0].find("maximum")->number == 1e6);
    CHECK(intensity->items[1].find("pattern")->text == "^-?[0-9.]+ ?(cd)$");
    const JsonValue& color = schema["$defs"]["point_light"]["properties"]["color"]["anyOf"];
    REQUIRE(color.items.size() == 3);
    CHECK(color.items[2]["$ref"].text == "#/$defs/name of a color");
    CHECK(schema["$defs"]["name of a color"]["enum"].items.size() == 148);
    const JsonValue& rotation = schema["$defs"]["transform"]["properties"]["rotation"];
    CHECK(rotation["items"]["anyOf"].items[1]["pattern"].text == "^-?[0-9.]+ ?(deg|rad)$");
    const JsonValue& at = schema["$defs"]["event"]["properties"]["at"]["anyOf"];
    REQUIRE(at.items.size() == 2);
    CHECK(at.items[0]["maximum"].number == 1e6);
    CHECK(at.items[1]["pattern"].text == "^-?[0-9.]+ ?(ms|min|s)$");
    CHECK(schema["$defs"]["node"]["properties"].find("spin") != nullptr);
    CHECK(schema["$defs"]["node"]["properties"].find("world_transform") == nullptr);
    for (const char* part : {"event", "node", "repeat of a node"}) {
        for (const JsonMember& property : schema["$defs"][part]["properties"].members) {
            CAPTURE(property.key);
            CHECK(
                (property.value.find("description") != nullptr
                 || property.value.find("$ref") != nullptr
                 || property.value.find("anyOf") != nullptr));
        }
    }
}

TEST_CASE("level: it binds keys to actions; actions and keys must exist") {
    register_game_components();
    World world;
    spawn_into(world, R"({"bindings": {"steer_left": ["J", "Left"], "boost": []}})");
    const auto& bindings = world.resource<Bindings>();
    const auto keys = [&](const char* name) -> std::vector<std::string> {
        for (const ActionGroup& group : action_groups()) {
            for (const ActionInfo& action : group.actions) {
                if (action.name == name) {
                    const std::span<const std::string> bound = keys_of(action, &bindings);
                    return {bound.begin(), bound.end()};
                }
            }
        }
        return {"no such action"};
    };
    CHECK(keys("steer_left") == std::vector<std::string>{"J", "Left"});
    CHECK(keys("steer_right") == std::vector<std::string>{"D", "Right"});  // its default
    CHECK(keys("boost").empty());

    const auto error = [](const char* text) {
        const Result<Level> level = parse_level(text, "t.level.json");
        return level.ok() ? std::string("none") : level.error().message;
    };
    CHECK(
        error(R"({"bindings": {"steer_lft": ["J"]}})")
        == "t.level.json:1:15: bindings.steer_lft: found the action \"steer_lft\", expected the "
           "name of one (did you mean steer_left?)");
    CHECK(error(R"({"bindings": {"steer_left": ["Space"]}})").find("Space") != std::string::npos);
    CHECK(
        error(R"({"bindings": {"steer_left": "J"}})").find("an array of keys")
        != std::string::npos);
}

}  // namespace limn::level_test
