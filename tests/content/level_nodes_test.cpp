// What a level changes of the nodes of a glTF file.

#include "content/load/level/level_update.h"
#include "content/load/scene_load.h"
#include "ecs/components/animation.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn::level_nodes_test {
namespace {

/// A lamp of two parts, and a joint without anything.
constexpr const char* kLamp = R"({
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 7}]}},
  "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
  "nodes": [
    {"name": "Bulb", "translation": [1, 2, 3], "scale": [2, 2, 2],
     "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"name": "Case", "mesh": 0},
    {"name": "arm.L"}],
  "materials": [{"name": "glass"}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}},
                             {"attributes": {"POSITION": 0}, "material": 0}]}],
  "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "bufferView": 1},
                {"componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1],
                 "bufferView": 0},
                {"componentType": 5126, "count": 2, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 36}],
  "buffers": [{"byteLength": 44, "uri": "data:application/octet-stream;base64,)"
                              R"(AAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA="}],
  "animations": [{"samplers": [{"input": 1, "output": 2}],
                  "channels": [{"sampler": 0, "target": {"node": 2, "path": "translation"}}]}]
})";

struct Scene {
    test::TemporaryFolder folder;
    World world;
    LevelFields fields;
    std::string error;

    /// `sections`: others of the level, each with a comma after it.
    explicit Scene(const std::string& entities, const std::string& sections = "") {
        std::ofstream(folder.file("lamp.gltf")) << kLamp;
        write(entities, sections);
        Result<LoadedScene> scene = load_scene(world, folder.file("t.level.json"));
        if (scene) {
            fields = std::move(scene->fields);
        } else {
            error = scene.error().message.substr(folder.path().size() + 1);
        }
    }
    void write(const std::string& entities, const std::string& sections = "") const {
        std::ofstream(folder.file("t.level.json"))
            << '{' << sections << R"("materials": {"amber": {}}, "entities": [)" << entities
            << "]}";
    }
    Entity find(std::string_view name, std::string_view owner) {
        Entity found;
        world.query<const Name>().each([&](Entity entity, const Name& own) {
            const Entity parent = parent_of(world, entity);
            if (own.text == name && world.alive(parent)
                && world.get<const Name>(parent).text == owner) {
                found = entity;
            }
        });
        return found;
    }
};

bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("level nodes: fields that are named change in one use of a file, the others stay") {
    Scene scene(R"(
        {"name": "left", "gltf": "lamp.gltf", "nodes": {
            "Bulb": {"point_light": {"intensity": 40}, "transform": {"scale": [1, 1, 1]}, "spin": {}}}},
        {"name": "right", "gltf": "lamp.gltf"},
        {"name": "dark", "gltf": "lamp.gltf", "nodes": {"Bulb": {"point_light": null}}})");
    REQUIRE_MESSAGE(scene.error.empty(), scene.error);
    World& world = scene.world;
    const Entity left = scene.find("Bulb", "left");
    const Entity right = scene.find("Bulb", "right");
    CHECK(world.get<const PointLight>(left).intensity == 40);
    CHECK(world.get<const PointLight>(right).intensity == 7);
    CHECK(world.get<const PointLight>(left).color == world.get<const PointLight>(right).color);
    CHECK(world.get<const Transform>(left).position == Vec3(1, 2, 3));
    CHECK(world.get<const Transform>(left).scale == Vec3(1));
    CHECK(world.get<const Transform>(right).scale == Vec3(2));
    CHECK(world.has<Spin>(left));
    CHECK_FALSE(world.has<Spin>(right));
    CHECK_FALSE(world.has<PointLight>(scene.find("Bulb", "dark")));
}

TEST_CASE("level nodes: fields may name entities of the level, also in copies") {
    Scene scene(R"(
        {"name": "face", "gltf": "lamp.gltf", "repeat": {"count": [2, 1, 1]}, "nodes": {
            "Bulb": {"surface_binding": {"surface": "take", "method": "patches"}}}},
        {"name": "other", "transform": {}},
        {"name": "take", "transform": {}})");
    REQUIRE_MESSAGE(scene.error.empty(), scene.error);
    Entity take;
    scene.world.query<const Name>().each(
        [&](Entity entity, const Name& own) { take = own.text == "take" ? entity : take; });
    REQUIRE_FALSE(take.is_null());
    int bound = 0;
    scene.world.query<const SurfaceBinding>().each([&](const SurfaceBinding& binding) {
        CHECK(binding.surface == take);
        ++bound;
    });
    CHECK(bound == 2);
    const Scene wrong(R"({"name": "face", "gltf": "lamp.gltf", "nodes": {
            "Bulb": {"surface_binding": {"surface": "tke"}}}}, {"name": "take"})");
    CHECK(has(wrong.error, "surface_binding.surface: found the entity \"tke\""));
    CHECK(has(wrong.error, "(did you mean take?)"));
}

TEST_CASE("level nodes: a material of the level goes to all parts of a node") {
    Scene scene(R"({"name": "left", "gltf": "lamp.gltf", "nodes": {
        "Case": {"mesh_instance": {"material": "amber"}}}})");
    REQUIRE_MESSAGE(scene.error.empty(), scene.error);
    int parts = 0;
    const Assets& assets = scene.world.resource<Assets>();
    scene.world.query<const MeshInstance>().each([&](const MeshInstance& part) {
        CHECK(assets.materials[part.material.index].name == "amber");
        CHECK(part.mesh.index < assets.meshes.size());
        ++parts;
    });
    CHECK(parts == 2);
}

TEST_CASE("level nodes: a part of a node of several goes by the name of its material") {
    Scene scene(
        R"({"name": "left", "gltf": "lamp.gltf", "nodes": {"glass": {"spin": {},
            "mesh_instance": {"material": "amber"}}}})");
    REQUIRE_MESSAGE(scene.error.empty(), scene.error);
    const auto& assets = scene.world.resource<Assets>();
    int spinning = 0;
    scene.world.query<const MeshInstance>().each([&](Entity part, const MeshInstance& instance) {
        const bool amber = assets.materials[instance.material.index].name == "amber";
        CHECK(scene.world.has<Spin>(part) == amber);
        spinning += amber ? 1 : 0;
    });
    CHECK(spinning == 1);
}

TEST_CASE("level nodes: a joint that is named becomes an entity, which follows the joint") {
    Scene plain(R"({"name": "left", "gltf": "lamp.gltf"})");
    CHECK(plain.find("arm.L", "left").is_null());
    Scene scene(
        R"({"name": "left", "gltf": "lamp.gltf", "nodes": {"arm.L": {"point_light": {}}}})");
    REQUIRE_MESSAGE(scene.error.empty(), scene.error);
    const Entity arm = scene.find("arm.L", "left");
    REQUIRE(scene.world.alive(arm));
    CHECK(scene.world.has<PointLight>(arm));
    CHECK(scene.world.has<JointAttachment>(arm));
}

TEST_CASE("level nodes: each use of a file has the variant of its materials that it names") {
    std::string lamp = kLamp;
    const auto edit = [&lamp](const std::string& from, const std::string& to) {
        REQUIRE(lamp.find(from) != std::string::npos);
        lamp.replace(lamp.find(from), from.size(), to);
    };
    edit(
        R"("material": 0})",
        R"("material": 0, "extensions": {"KHR_materials_variants": {"mappings": [
           {"material": 1, "variants": [0]}]}}})");
    edit(R"([{"name": "glass"}])", R"([{"name": "glass"}, {"name": "ruby"}])");
    edit(
        R"("extensions": {"KHR_lights)",
        R"("extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}]}, "KHR_lights)");
    Scene scene("{}");
    std::ofstream(scene.folder.file("lamp.gltf")) << lamp;
    const auto materials_of = [&](const std::string& entities) {
        scene.write(entities);
        World world;
        const Result<LoadedScene> loaded = load_scene(world, scene.folder.file("t.level.json"));
        REQUIRE_MESSAGE(loaded.ok(), (loaded ? "" : loaded.error().message));
        std::vector<std::string> names;
        const Assets& assets = world.resource<Assets>();
        world.query<const MeshInstance>().each([&](const MeshInstance& instance) {
            names.push_back(assets.materials[instance.material.index].name);
        });
        std::ranges::sort(names);
        return names;
    };
    using Names = std::vector<std::string>;
    CHECK(materials_of(R"({"gltf": "lamp.gltf"})") == Names{"default", "glass"});
    CHECK(
        materials_of(R"({"gltf": "lamp.gltf", "variant": "red"}, {"gltf": "lamp.gltf"},
                        {"gltf": "lamp.gltf", "variant": "red"})")
        == Names{"default", "default", "default", "glass", "ruby", "ruby"});
    scene.write(R"({"gltf": "lamp.gltf", "variant": "blue"})");
    World world;
    CHECK(load_scene(world, scene.folder.file("t.level.json"))
              .error()
              .message.ends_with(
                  "lamp.gltf: found no material variant \"blue\", expected one of red"));
    scene.write(R"({"variant": "red"})");
    CHECK(load_scene(world, scene.folder.file("t.level.json"))
              .error()
              .message.ends_with("found a variant without a glTF file, expected \"gltf\" as well"));
}

TEST_CASE("level nodes: a prefab's changes come first, and each copy has them") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("lamp.gltf")) << kLamp;
    std::ofstream(folder.file("t.level.json")) << R"({"prefabs": {"lamp": {"gltf": "lamp.gltf",
        "nodes": {"Bulb": {"point_light": {"intensity": 1, "radius": 3}}}}},
        "entities": [{"name": "a", "prefab": "lamp", "repeat": {"count": [3, 1, 1]},
                      "nodes": {"Bulb": {"point_light": {"intensity": 2}}}}]})";
    World world;
    const Result<LoadedScene> scene = load_scene(world, folder.file("t.level.json"));
    REQUIRE_MESSAGE(scene.ok(), (scene ? std::string() : scene.error().message));
    int lamps = 0;
    world.query<const PointLight>().each([&](const PointLight& light) {
        CHECK(light.intensity == 2);
        CHECK(light.radius == 3);
        ++lamps;
    });
    CHECK(lamps == 3);
}

TEST_CASE("level nodes: children of a prefab change by name, others and their fields stay") {
    const Scene scene(
        R"({"name": "a", "prefab": "pair", "nodes": {
        "left": {"point_light": {"intensity": 3}}, "low": {"point_light": null}}},
      {"name": "b", "prefab": "pair"})",
        R"("prefabs": {"pair": {"children": [
        {"name": "left", "point_light": {"intensity": 1, "radius": 5}, "children": [
          {"name": "low", "point_light": {"intensity": 2, "radius": 5}}]}]}},)");
    REQUIRE_MESSAGE(scene.error.empty(), scene.error);
    std::vector<float> lights;
    scene.world.query<const PointLight>().each([&](const PointLight& light) {
        CHECK(light.radius == 5);
        lights.push_back(light.intensity);
    });
    std::sort(lights.begin(), lights.end());
    CHECK(lights == std::vector<float>{1, 2, 3});

    for (const auto& [nodes, message] :
         {std::pair{
              R"({"lef": {"spin": {}}})",
              "expected the name of a child or of its children (did you mean left?)"},
          {R"({"left": {"children": []}})", "found the key \"children\", expected components"},
          {R"({"left": 3})", "expected an object: components by name"}}) {
        const Scene wrong(
            std::string(R"({"children": [{"name": "left"}], "nodes": )") + nodes + "}");
        CHECK_MESSAGE(has(wrong.error, message), wrong.error);
        CHECK(wrong.error.starts_with("t.level.json:1:"));
    }
}

TEST_CASE("level nodes: what a file does not have is refused with its place and the nearest name") {
    const struct {
        const char* entity;
        const char* message;
    } kCases[] = {
        {R"({"gltf": "lamp.gltf", "nodes": {"Blub": {"spin": {}}}})",
         "t.level.json:1:75: nodes: found the node \"Blub\", expected a node of lamp.gltf (did you "
         "mean "
         "Bulb?)"},
        {R"({"name": "a", "nodes": {"Bulb": {}}})",
         "entity \"a\": found nodes without a glTF file or children, expected \"gltf\", "
         "\"prefab\" or \"children\" as well"},
        {R"({"name": "a", "gltf": "lamp.gltf", "nodes": {"Bulb": {"point_ligt": {}}}})",
         "entity \"a\".nodes.Bulb: found the component \"point_ligt\", expected one of `limn "
         "components` (did you mean point_light?)"},
        {R"({"name": "a", "gltf": "lamp.gltf", "nodes": {"Bulb": {"point_light": {"intensity": -1}}}})",
         "entity \"a\".nodes.Bulb.point_light.intensity: found the number -1, expected a number 0 "
         ".. "
         "1000000 cd"},
        {R"({"name": "a", "gltf": "lamp.gltf", "nodes": {"Bulb": {"clip_player": {"clip": "none"}}}})",
         "nodes.Bulb.clip_player: found the clip \"none\""},
        {R"({"name": "a", "gltf": "lamp.gltf", "nodes": {"Bulb": {"autofocus": {"target": "b"}}}})",
         "entity \"a\": autofocus.target: found the entity \"b\", expected an existing name"},
        {R"({"name": "a", "gltf": "lamp.gltf", "nodes": [1]})",
         "expected an object: nodes of the glTF file by name"},
    };
    for (const auto& [entity, message] : kCases) {
        const Scene scene(entity);
        CHECK_MESSAGE(has(scene.error, message), scene.error);
        CHECK(scene.error.starts_with("t.level.json:1:"));
        CHECK(scene.world.entity_count() == 0);
    }
}

TEST_CASE("level nodes: other changes need the level loaded again") {
    const auto with = [](const char* intensity) {
        return std::string(R"({"name": "a", "gltf": "lamp.gltf", "nodes": {"Bulb": {"point_light":
            {"intensity": )")
               + intensity + "}}}}";
    };
    Scene scene(with("3"));
    REQUIRE_MESSAGE(scene.error.empty(), scene.error);
    const Result<std::vector<LevelChange>> same = update_level(scene.world, scene.fields);
    REQUIRE(same.ok());
    CHECK(same->empty());
    scene.write(with("4"));
    const Result<std::vector<LevelChange>> other = update_level(scene.world, scene.fields);
    REQUIRE_FALSE(other.ok());
    CHECK(has(other.error().message, "changes of glTF nodes differ: reload the level"));
}

}  // namespace limn::level_nodes_test
