#include "content/game/game.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/level/level_schema.h"
#include "ecs/base/log.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/post.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "tests/content/level_text.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <set>
#include <string>

namespace limn::level_test {

/// A kind of component that only this file knows.
struct Lantern {
    float oil = 1;
    Entity owner;
};

LIMN_FIELDS(Lantern) {
    LIMN_FIELD(oil, "what is left to burn", "kg", 0, 10);
    LIMN_FIELD(owner, "who carries it");
}

namespace {

using test::find_named;
using test::named;
using test::parse;
using test::spawn_into;

}  // namespace

TEST_CASE("level: an empty one is a level") {
    const Level level = parse("{}");
    CHECK(level.name == "t");
    CHECK(level.entities.entities.empty());
    World world;
    CHECK(spawn_level(world, level).empty());
}

TEST_CASE(
    "level: resources, materials, meshes and entities arrive in the world as written"
    * technique("engine.object-text")) {
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

TEST_CASE(
    "level: a kind of component that was registered is loaded, listed, copied, attached and saved"
    * technique("engine.type-registry")) {
    register_component<Lantern>();
    World world;
    spawn_into(world, R"({
        "prefabs": {"guard": {"children": [{"lantern": {"oil": 3, "owner": "post"}}]}},
        "entities": [{"name": "post"}, {"prefab": "guard"}, {"prefab": "guard"}]
    })");
    const auto lanterns_of = [](const World& from) {
        std::vector<Lantern> lanterns;
        from.query<const Lantern, const Parent>().each(
            [&](const Lantern& lantern, const Parent&) { lanterns.push_back(lantern); });
        return lanterns;
    };
    const std::vector<Lantern> lanterns = lanterns_of(world);
    REQUIRE(lanterns.size() == 2);
    for (const Lantern& lantern : lanterns) {
        CHECK(lantern.oil == 3.0f);
        CHECK(lantern.owner == find_named(world, "post"));
    }
    CHECK(write_json(level_schema()).find("\"lantern\"") != std::string::npos);

    const Result<std::vector<std::byte>> saved = save_snapshot(world);
    REQUIRE(saved.ok());
    World restored;
    REQUIRE(restore_snapshot(restored, *saved).ok());
    CHECK(lanterns_of(restored).size() == 2);
}

TEST_CASE("level: a camera with a path begins where the path does") {
    World world;
    spawn_into(world, R"({"entities": [{"name": "c", "camera": {}, "camera_path": {"keys": [
        {"time": 0, "position": [3, 1, 0], "look_at": [0, 1, 0]}, {"time": 2, "position": [0, 1, 3]}]}}]})");
    const Transform& t = named<Transform>(world, "c");
    CHECK(t.position == Vec3(3, 1, 0));
    CHECK((t.rotation * Vec3(0, 0, -1)).x == test::near(-1.0f));
}

TEST_CASE("level: events remove only components that a level can have") {
    for (const char* const name : {"parent", "name", "particle_pool"}) {
        const Result<Level> level = parse_level(
            R"({"entities": [{"name": "lamp"}],
                "events": [{"at": 1, "set": {"lamp": {")"
                + std::string(name) + R"(": null}}}]})",
            "t.level.json");
        REQUIRE_FALSE(level.ok());
        CHECK(
            level.error().message.find("null for the component \"" + std::string(name))
            != std::string::npos);
    }
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
            {"at": 1, "every": 1, "set": {"lamp": {"orbit_camera": {"target": "lamp"}}}},
            {"at": 2, "set": {"lamp": {"point_light": null, "spin": {}}}}]})");
    const EventList& list = world.resource<EventList>();
    REQUIRE(list.events.size() == 3);
    CHECK(list.events[2].actions.at(0).action == EventAction::Remove);
    CHECK(&list.events[2].actions[0].value.info() == &component_info<PointLight>());
    CHECK(list.events[2].actions.at(1).action == EventAction::Set);
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
