// What a level says that has no effect, or not the one that its author expects.

#include "content/load/faces/inside_mesh.h"
#include "content/load/level/level_load.h"
#include "content/load/level/scene_warnings.h"
#include "content/load/scene_load.h"
#include "ecs/components/all.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/components/wrinkle.h"
#include "ecs/components/wrinkle_ladder.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/components/wrinkle_response.h"
#include "ecs/world.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace limn::scene_warnings_test {
namespace {

std::vector<std::string> warnings_of(std::string_view text) {
    register_all_components();
    Result<Level> level = parse_level(text, "t.level.json");
    REQUIRE_MESSAGE(level.ok(), (level ? std::string() : level.error().message));
    REQUIRE(load_level_assets(*level, ".").ok());
    World world;
    (void)spawn_level(world, *std::move(level));
    std::vector<std::string> lines;
    for (const SceneWarning& warning : find_scene_warnings(world)) {
        lines.push_back(warning.text);
    }
    return lines;
}

using Warnings = std::vector<std::string>;

}  // namespace

TEST_CASE("scene warnings: keyframes whose times do not increase") {
    CHECK(warnings_of(R"({"entities": [{"name": "eye", "camera": {},
        "camera_path": {"keys": [{"time": 0}, {"time": 1}, {"time": 2}]}}]})")
              .empty());
    CHECK(
        warnings_of(R"({"entities": [{"name": "eye", "camera": {},
        "camera_path": {"keys": [{"time": 0}, {"time": 2}, {"time": 1}]}}]})")
        == Warnings{"entity \"eye\": camera_path.keys[2].time is 1 s, not after the previous key "
                    "(2 s)"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "pot",
        "rotation_track": {"keys": [{"time": 1}, {"time": 1}]}}]})")
        == Warnings{
            "entity \"pot\": rotation_track.keys[1].time is 1 s, not after the previous key "
            "(1 s)"});
}

TEST_CASE("scene warnings: key tracks that animate nothing") {
    CHECK(warnings_of(R"({"entities": [{"name": "lamp", "point_light": {}, "key_track": {"tracks": [
        {"field": "point_light.radius", "times": [0, 1], "values": [1, 2]}]}}]})")
              .empty());
    CHECK(
        warnings_of(R"({"entities": [{"name": "lamp", "point_light": {}, "key_track": {"tracks": [
        {"field": "point_light.radius", "times": [0, 1, 1], "values": [1, 2, 3]},
        {"field": "spot_light.radius", "times": [0], "values": [1]}]}}]})")
        == Warnings{
            "entity \"lamp\": key_track: point_light.radius: times: found 1 s at key 2, expected "
            "more than the key before",
            "entity \"lamp\": key_track: spot_light.radius has no effect without spot_light"});
}

TEST_CASE("scene warnings: components that have no effect without another") {
    CHECK(
        warnings_of(R"({"entities": [{"name": "eye", "camera": {}, "autofocus": {}}]})")
        == Warnings{"entity \"eye\": autofocus has no effect without lens"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "eye", "autofocus": {}}]})")
        == Warnings{"entity \"eye\": autofocus has no effect without camera and lens"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "eye", "camera_path": {"keys": [{}]}}]})")
        == Warnings{"entity \"eye\": camera_path has no effect without camera"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "fox", "motion_graph": {}, "motion_style": {}},
            {"name": "hen", "motion_style": {}}]})")
        == Warnings{
            "entity \"fox\": motion_graph has no effect without skeleton",
            "entity \"hen\": motion_style has no effect without motion_graph"});
}

TEST_CASE("scene warnings: what meets water, where there is none, or none with waves") {
    const auto with = [](const char* water) {
        return warnings_of(
            R"({"entities": [{"name": "rock", "transform": {}, "water_wall": {}, "wake_emitter": {}},
                {"name": "mole", "transform": {}, "particle_look": {}, "particle_emitter": {},
                 "spray_obstacle": {}})"
            + std::string(water) + "]}");
    };
    CHECK(
        with("")
        == Warnings{
            "entity \"mole\": spray_obstacle has no effect without a water",
            "entity \"rock\": water_wall has no effect without a water",
            "entity \"rock\": wake_emitter has no effect without a water with water_waves"});
    CHECK(
        with(R"(, {"name": "pond", "transform": {}, "water": {}})")
        == Warnings{
            "entity \"rock\": wake_emitter has no effect without a water with water_waves"});
    CHECK(
        with(R"(, {"name": "pond", "transform": {}, "water": {}, "water_waves": {}})")
        == Warnings{});
    CHECK(
        warnings_of(
            R"({"entities": [{"name": "sea", "transform": {}, "water": {}, "spray_source": {}},
            {"name": "buoy", "transform": {}, "floating": {}}]})")
        == Warnings{
            "entity \"sea\": spray_source has no effect without water_waves or ocean and "
            "particle_emitter",
            "entity \"buoy\": floating has no effect without water_touch"});
}

TEST_CASE("scene warnings: surfaces that are missing, or that emit nothing") {
    CHECK(
        warnings_of(R"({"entities": [
        {"name": "a", "particle_surface": {}},
        {"name": "b", "particle_emitter": {}, "particle_look": {}, "particle_surface": {}},
        {"name": "c", "particle_emitter": {}, "particle_look": {}, "particle_surface": {"on": "path"}},
        {"name": "d", "particle_emitter": {}, "particle_look": {}, "particle_surface": {"on": "pieces"}},
        {"name": "e", "particle_emitter": {"executor": "gpu"}, "particle_look": {}, "mesh_instance": {},
            "particle_surface": {}},
        {"name": "f", "particle_emitter": {}, "particle_look": {}, "mesh_instance": {},
            "particle_surface": {}, "particle_source": {"emitter": "e"}},
        {"name": "g", "particle_emitter": {}, "particle_look": {}, "particle_surface": {"entity": "e"}}]})")
        == Warnings{
            "entity \"a\": particle_surface has no effect without particle_emitter",
            "entity \"a\": particle_surface on a mesh needs an entity with mesh_instance",
            "entity \"b\": particle_surface on a mesh needs an entity with mesh_instance",
            "entity \"c\": particle_surface on a path needs a path",
            "entity \"d\": particle_surface on pieces needs a particle_mesh of \"fragments\"",
            "entity \"f\": particle_surface has no effect beside a particle_source",
            "entity \"f\": particle_source has no effect with GPU particles, which give birth to "
            "no "
            "others; set the particle_emitter.executor of its emitter to cpu"});
}

TEST_CASE("scene warnings: missing colliders") {
    CHECK(
        warnings_of(R"({"entities": [{"name": "sparks", "particle_emitter": {},
        "particle_look": {}, "particle_collision": {}}]})")
        == Warnings{
            "entity \"sparks\": particle_collision has no effect without a particle_collider"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "a", "particle_collider": {"shape": "mesh"}},
        {"name": "b", "particle_collider": {"shape": "water"}},
        {"name": "c", "particle_collider": {"shape": "height_field"}},
        {"name": "d", "particle_collider": {"shape": "box"}}]})")
        == Warnings{
            "entity \"a\": particle_collider of this shape needs mesh_instance",
            "entity \"b\": particle_collider of this shape needs water",
            "entity \"c\": particle_collider of this shape needs noise_surface, height_image or "
            "shoaling_waves"});
}

TEST_CASE("scene warnings: what GPU particles cannot do") {
    CHECK(
        warnings_of(R"({"entities": [{"name": "sparks", "particle_look": {},
        "particle_emitter": {"executor": "gpu"}, "particle_light": {}}]})")
        == Warnings{"entity \"sparks\": particle_light has no effect on GPU particles; set "
                    "particle_emitter.executor to cpu"});
    CHECK(
        warnings_of(R"({"entities": [
        {"name": "sparks", "particle_look": {"lit_at": "middle"}, "particle_emitter": {"executor": "gpu"}},
        {"name": "smoke", "particle_look": {"lit_at": "middle"}, "particle_emitter": {}},
        {"name": "mist", "particle_look": {}, "particle_emitter": {"executor": "gpu"}}]})")
        == Warnings{
            "entity \"sparks\": particle_look.lit_at has no effect on GPU particles, "
            "whose light is evaluated at their corners; set particle_emitter.executor to cpu"});
}

TEST_CASE("scene warnings: bodies with a mass that cannot move, and forces without a body") {
    CHECK(
        warnings_of(R"({"entities": [{"name": "cart", "transform": {}, "children": [
            {"name": "shot", "transform": {}, "point_mass": {}}]}]})")
        == std::vector<std::string>{
            R"(entity "shot": point_mass has no effect on an entity that has a parent)"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "shot", "transform": {}, "air_drag": {}}]})")
        == std::vector<std::string>{R"(entity "shot": air_drag has no effect without point_mass)"});
    CHECK(warnings_of(R"({"entities": [{"transform": {}, "point_mass": {}, "air_drag": {}}]})")
              .empty());
}

TEST_CASE("scene warnings: a resolution that is rounded, with its field") {
    CHECK(
        warnings_of(R"({"entities": [{"name": "lamp", "spot_light": {},
        "shadow": {"resolution": 700}}]})")
        == Warnings{"entity \"lamp\": shadow.resolution 700 is rounded to the power of two 1024"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "sea", "water": {}, "ocean": {"resolution": 100}}]})")
        == Warnings{"entity \"sea\": ocean.resolution 100 is rounded to the power of two 64"});
    CHECK(
        warnings_of(R"({"entities": [{"name": "hall", "env_probe": {"resolution": 100}}]})")
        == Warnings{"entity \"hall\": env_probe.resolution 100 is rounded to the power of two 64"});
}

TEST_CASE("scene warnings: an atmosphere without a sun, and a sun that lights nothing") {
    const auto with = [](const char* sun) {
        return warnings_of(fmt::format(
            R"({{"resources": {{"environment": {{"sky": "atmosphere"}}}},
                "entities": [{{"name": "sun", "transform": {{"rotation": [0, -40, 0]}}{}}}]}})",
            sun));
    };
    CHECK(
        with(R"(, "directional_light": {})")
        == Warnings{"environment: the sky \"atmosphere\" is black without a sunlight"});
    CHECK(
        with(R"(, "sunlight": {})")
        == Warnings{
            "entity \"sun\": sunlight has no effect without directional_light",
            "environment: the sky \"atmosphere\" is black without a sunlight"});
    CHECK(with(R"(, "sunlight": {}, "directional_light": {})").empty());
}

TEST_CASE("scene warnings: events on a component that the entity lacks") {
    const auto with = [](const char* components, const char* action) {
        return fmt::format(
            R"({{"entities": [{{"name": "box"{}}}],
                "events": [{{"at": 1, "{}": {{"box": {{"spin": {{"speed": 2}}}}}}}}]}})",
            components, action);
    };
    CHECK(warnings_of(with(R"(, "spin": {})", "set")).empty());
    CHECK(
        warnings_of(with("", "set"))
        == Warnings{"events[0]: entity \"box\" has no spin; the event adds it with defaults"});
    CHECK(
        warnings_of(with("", "impulse"))
        == Warnings{"events[0]: entity \"box\" has no spin; the event does nothing"});
}

TEST_CASE("scene warnings: a camera inside a solid mesh") {
    const auto with = [](const char* place, const char* mesh, const char* material) {
        return fmt::format(
            R"({{"meshes": {{"m": {{{}}}}}, "materials": {{"a": {{{}}}}},
                "entities": [
                {{"name": "wall", "transform": {{"position": [5, 0, 0], "rotation": [30, 0, 0],
                    "scale": [2, 3, 4]}}, "children": [
                    {{"name": "stone", "transform": {{"position": [0, 1, 0]}},
                      "mesh_instance": {{"mesh": "m", "material": "a"}}}}]}},
                {{"name": "rig", "transform": {{"position": [1, 0, 0]}}, "children": [
                    {{"name": "eye", "transform": {{"position": {}}}, "camera": {{}}}}]}}]}})",
            mesh, material, place);
    };
    const std::string box = R"("make": "box", "size": [1, 1, 1])";
    const Warnings inside = {
        "entity \"eye\": the camera starts inside entity \"stone\", at [5, 3, 0]"};
    // The box is 2 x 3 x 4 m about (5, 3, 0).
    CHECK(warnings_of(with("[4, 3, 0]", box.c_str(), "")) == inside);
    CHECK(warnings_of(with("[4, 4.4, 0]", box.c_str(), "")).size() == 1);
    CHECK(warnings_of(with("[4, 4.6, 0]", box.c_str(), "")).empty());
    CHECK(warnings_of(with("[5.73, 3, 1.195]", box.c_str(), "")).size() == 1);  // near a corner
    CHECK(warnings_of(with("[4.95, 3, -1.9]", box.c_str(), "")).empty());
    CHECK(warnings_of(with("[4, 3, 0]", R"("make": "sphere")", "")) == inside);
    // What is open, transparent or a room with an inside is none of it.
    CHECK(warnings_of(with("[4, 3, 0]", R"("make": "plane")", "")).empty());
    CHECK(warnings_of(with("[4, 3, 0]", box.c_str(), R"("double_sided": true)")).empty());
    CHECK(warnings_of(with("[4, 3, 0]", box.c_str(), R"("alpha_mode": "blend")")).empty());
}

TEST_CASE("inside mesh: the winding number is 1 in a closed mesh and 0 outside") {
    MeshData tetrahedron;
    tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tetrahedron.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    CHECK(winding_number(tetrahedron, {0.2f, 0.2f, 0.2f}) == test::near(1));
    CHECK(winding_number(tetrahedron, {0.01f, 0.01f, 0.97f}) == test::near(1));
    CHECK(std::abs(winding_number(tetrahedron, {0.4f, 0.4f, 0.4f})) < 1e-12);
    CHECK(std::abs(winding_number(tetrahedron, {-3, 1, 2})) < 1e-12);
    MeshData turned = tetrahedron;
    for (std::size_t i = 0; i < turned.indices.size(); i += 3) {
        std::swap(turned.indices[i], turned.indices[i + 1]);
    }
    CHECK(winding_number(turned, {0.2f, 0.2f, 0.2f}) == test::near(-1));
    // From its center, a face of a cube fills a sixth of the sphere.
    MeshData face;
    face.positions = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
    face.indices = {0, 1, 2, 0, 2, 3};
    CHECK(winding_number(face, {0, 0, 0}) == test::near(1.0 / 6));
}

TEST_CASE("scene warnings: caustics without a sun above the horizon") {
    const auto with = [](const char* light) {
        return fmt::format(
            R"({{"entities": [{{"name": "pool", "water": {{}}, "caustics": {{}}}}, {}]}})", light);
    };
    CHECK(warnings_of(with(R"({"transform": {"rotation": [0, -30, 0]}, "directional_light": {}})"))
              .empty());
    CHECK(warnings_of(with(R"({"transform": {"rotation": [0, -30, 0]},
        "children": [{"directional_light": {"enabled": false}}]})"))
              .empty());
    for (const char* const light :
         {R"({"point_light": {}})", R"({"directional_light": {}})",
          R"({"transform": {"rotation": [0, 30, 0]}, "directional_light": {}})"}) {
        CAPTURE(light);
        CHECK(
            warnings_of(with(light))
            == Warnings{"entity \"pool\": caustics has no effect without a directional_light from "
                        "above"});
    }
}

TEST_CASE("scene warnings: a sun far too bright for the exposure") {
    const auto level = [](std::string_view exposure, std::string_view sun) {
        return fmt::format(
            R"({{"resources": {{{}}}, "entities": [{{"name": "sun",
                "directional_light": {{"illuminance": {}}}}}]}})",
            exposure, sun);
    };
    CHECK(
        warnings_of(level("", "40000"))
        == Warnings{
            "entity \"sun\": 40000 lx is far too bright for the exposure, which suits about "
            "5 lx, as skies and effects do; \"exposure\": {\"metering\": \"auto\"} follows any "
            "light"});
    CHECK(warnings_of(level(R"("exposure": {"ev": 2})", "30")).size() == 1);
    CHECK(warnings_of(level("", "26")).empty());
    CHECK(warnings_of(level(R"("exposure": {"manual_ev": -13})", "40000")).empty());
    CHECK(warnings_of(level(R"("exposure": {"metering": "auto"})", "40000")).empty());
}

TEST_CASE("scene warnings: the color of a light is no intensity") {
    CHECK(warnings_of(R"({"entities": [{"point_light": {"color": [1, 0.5, 0]}}]})").empty());
    CHECK(
        warnings_of(R"({"entities": [{"name": "lamp", "spot_light": {"color": [3, 1.5, 0]}},
                                     {"name": "sun", "directional_light": {"color": [2, 2, 2]}}]})")
        == Warnings{
            "entity \"lamp\": spot_light.color is a tint in 0 .. 1, found [3, 1.5, 0]; raise "
            "spot_light.intensity instead",
            "entity \"sun\": directional_light.color is a tint in 0 .. 1, found [2, 2, 2]; raise "
            "directional_light.illuminance instead"});
}

TEST_CASE("scene warnings: events on an entity that is destroyed before") {
    const auto with = [](const char* events) {
        return fmt::format(
            R"({{"entities": [{{"name": "box", "spin": {{}}, "children": [{{"name": "lid"}}]}}],
                "events": [{}]}})",
            events);
    };
    CHECK(warnings_of(with(R"({"at": 2, "destroy": ["box"]},
        {"at": 1, "every": 1, "impulse": {"box": {"transform": {"position": [0, 1, 0]}}}},
        {"at": 1, "destroy": ["lid"]})"))
              .empty());
    CHECK(
        warnings_of(with(R"({"at": 2, "set": {"lid": {"spin": {"speed": 1}}}},
                            {"at": 1, "destroy": ["box"]},
                            {"at": 1, "destroy": ["box"], "set_resources": {"glow": {"strength": 1}}})"))
        == Warnings{
            "events[0]: entity \"lid\" no longer exists: events[1] destroys it at 1 s",
            "events[2]: entity \"box\" no longer exists: events[1] destroys it at 1 s"});
}

TEST_CASE("scene warnings: a warning names the position in the level's file") {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("t.level.json");
    std::ofstream(path) << R"({"prefabs": {"lamp": {"children": [
    {"shadow": {}}]}},
  "entities": [
    {"name": "a", "prefab": "lamp"}, {"shadow": {}}],
  "events": [
    {"at": 1, "impulse": {"a": {"spin": {"speed": 1}}}}]})";
    const std::vector<std::string> lines = test::messages_of([&] {
        World world;
        CHECK(load_scene(world, path).ok());
    });
    const std::string shadow =
        "shadow has no effect without point_light or spot_light or directional_light";
    CHECK(
        lines
        == Warnings{
            path + ":2:5: entity 1: " + shadow, path + ":4:38: entity 2: " + shadow,
            path + ":6:5: events[0]: entity \"a\" has no spin; the event does nothing"});
}

TEST_CASE("scene warnings: several active cameras, with the position of the last") {
    register_all_components();
    const test::TemporaryFolder folder;
    const std::string path = folder.file("t.level.json");
    std::ofstream(path) << R"({"entities": [
    {"name": "a", "camera": {}}, {"name": "b", "camera": {"active": false}},
    {"name": "c", "camera": {}}]})";
    const std::vector<std::string> lines = test::messages_of([&] {
        World world;
        CHECK(load_scene(world, path).ok());
    });
    CHECK(
        lines
        == Warnings{
            path
            + ":3:5: 2 active cameras: entity \"a\", entity \"c\"; the first is used, set "
              "\"active\": false on the others"});
}

TEST_CASE("scene warnings: internal state of systems in a level") {
    register_all_components();
    const std::vector<std::string> logged = test::messages_of([] {
        CHECK(parse_level(R"({"entities": [{"name": "a", "world_transform": {}}]})", "t.level.json")
                  .ok());
    });
    REQUIRE(logged.size() == 1);
    CHECK(
        logged[0]
        == "t.level.json:1:29: entity \"a\": systems keep world_transform and overwrite "
           "what is written here");
}

TEST_CASE(
    "scene warnings: wrinkle maps and masks of another aspect ratio than the skin"
    * technique("wrinkle.maps.texture-set")) {
    World world;
    Assets assets;
    const auto add = [&](const char* name, int width, int height) {
        assets.images.push_back({.name = name, .width = width, .height = height, .pixels = {}});
        return ImageId{static_cast<std::uint32_t>(assets.images.size() - 1)};
    };
    WrinkleMaps maps;
    maps.base = add("skin", 512, 256);
    maps.stretched = add("surprise", 256, 128);  // of another size, but it lies over it
    maps.compressed = maps.stretched;
    maps.first_masks = add("masks", 64, 64);
    maps.target = add("target", 512, 256);
    world.insert_resource(std::move(assets));
    world.create(Name{"face"}, maps, WrinkleWeights{});
    const std::vector<SceneWarning> found = find_scene_warnings(world);
    REQUIRE(found.size() == 1);
    CHECK(
        found[0].text
        == "entity \"face\": wrinkle_maps.first_masks \"masks\" is 64 x 64 px; expected the "
           "aspect ratio of base \"skin\", 512 x 256 px: its wrinkles are not drawn");
}

TEST_CASE(
    "scene warnings: rungs of wrinkles out of order, and regions that respond twice"
    * technique("skin.pipeline")) {
    World world;
    world.insert_resource(Assets{});
    world.create(Name{"near"}, WrinkleLadder{.displaced_from = 100, .strain_from = 200});
    world.create(Name{"far"}, WrinkleLadder{.strain_from = 30, .maps_from = 64});
    world.create(Name{"right"}, WrinkleLadder{.strain_from = 64, .maps_from = 64});
    WrinkleResponse response;
    for (const WrinkleRegion region :
         {WrinkleRegion::Lips, WrinkleRegion::Chin, WrinkleRegion::Lips}) {
        response.regions.push_back({.region = region});
    }
    world.create(Name{"twice"}, response);
    std::vector<std::string> found;
    for (const SceneWarning& warning : find_scene_warnings(world)) {
        const bool is_meant = warning.text.find("wrinkle_ladder: found") != std::string::npos
                              || warning.text.find("wrinkle_response.regions") != std::string::npos;
        if (is_meant) {
            found.push_back(warning.text);
        }
    }
    REQUIRE(found.size() == 3);
    CHECK(found[0].starts_with("entity \"near\": wrinkle_ladder: found displaced_from 100, "
                               "strain_from 200, maps_from 64 px; expected them to fall"));
    CHECK(found[1].starts_with("entity \"far\": wrinkle_ladder: found displaced_from 512"));
    CHECK(
        found[2]
        == "entity \"twice\": wrinkle_response.regions[2]: found lips again; only the first one "
           "counts");
}

TEST_CASE("scene warnings: regions and shapes of wrinkles that the mesh does not have") {
    const auto found = [](const char* fields) {
        return warnings_of(fmt::format(
            R"({{"meshes": {{"face": {{"make": "sphere"}}}}, "entities": [{{"name": "face",
                "mesh_instance": {{"mesh": "face"}}, "wrinkle_surface": {{{}}}}}]}})",
            fields));
    };
    CHECK(
        found(R"("method": "none", "regions": ["brow"])")
        == Warnings{"entity \"face\": wrinkle_surface.regions[0]: found \"brow\", no region of "
                    "mesh \"face\"; expected one of a mesh that has any"});
    World world;
    Assets assets;
    MeshData& mesh = assets.meshes.emplace_back();
    mesh.name = "head";
    mesh.regions.resize(2);
    mesh.regions[0].name = "forehead";
    mesh.regions[1].name = "chin";
    mesh.morphs.emplace_back().name = "age";
    world.insert_resource(std::move(assets));
    WrinkleSurface surface = {.method = WrinkleMethod::None};
    surface.regions = {"chin"};
    surface.second_regions = {"chin", "forhead"};
    surface.resting = {{"forehead", 0.1f}, {"cheek", 0.1f}};
    surface.resting_shape = "age";
    world.create(Name{"face"}, MeshInstance{MeshId{0}, {}}, surface);
    surface = {.method = WrinkleMethod::None};
    surface.resting_shape = "old";
    world.create(Name{"other"}, MeshInstance{MeshId{0}, {}}, surface);
    Warnings lines;
    for (const SceneWarning& warning : find_scene_warnings(world)) {
        lines.push_back(warning.text);
    }
    CHECK(
        lines
        == Warnings{
            "entity \"face\": wrinkle_surface.second_regions[1]: found \"forhead\", no region of "
            "mesh \"head\"; expected one of forehead chin",
            "entity \"face\": wrinkle_surface.resting[1].region: found \"cheek\", no region of "
            "mesh \"head\"; expected one of forehead chin",
            "entity \"other\": wrinkle_surface.resting_shape: found \"old\", no shape of mesh "
            "\"head\"; expected one of age"});
}

TEST_CASE("scene warnings: wrinkles whose material has no map of them") {
    World world;
    Assets assets;
    assets.meshes.emplace_back();
    assets.images.emplace_back();
    assets.materials.resize(2);
    assets.materials[1].wrinkle_texture.image = ImageId{0};
    world.insert_resource(std::move(assets));
    const auto create = [&](const char* name, WrinkleMethod method, MaterialId material) {
        world.create(
            Name{name}, MeshInstance{MeshId{0}, material}, WrinkleSurface{.method = method});
    };
    create("smooth", WrinkleMethod::Isometric, MaterialId{0});
    create("gray", WrinkleMethod::Alpha, MaterialId{});
    create("folded", WrinkleMethod::Isometric, MaterialId{1});
    create("strained", WrinkleMethod::StrainView, MaterialId{0});
    create("none", WrinkleMethod::None, MaterialId{0});
    Warnings lines;
    for (const SceneWarning& warning : find_scene_warnings(world)) {
        lines.push_back(warning.text);
    }
    const char* const kText =
        "wrinkle_surface draws nothing unless its material has a wrinkle_texture";
    CHECK(
        lines
        == Warnings{
            fmt::format("entity \"smooth\": {}", kText),
            fmt::format("entity \"gray\": {}", kText)});
}

TEST_CASE(
    "scene warnings: a wrinkle map too steep for the fit to the unit sphere, and by how much"
    * technique("wrinkle.compression.map")) {
    World world;
    Assets assets;
    assets.meshes.emplace_back();
    // x^2 + y^2 of 0.55, 0.7, 0 and 0.66: two are beyond 0.6.
    assets.images.push_back(
        {.name = "mine",
         .width = 2,
         .height = 2,
         .pixels = {
             222, 128, 200, 255, 234, 128, 200, 255, 128, 128, 255, 255, 201, 201, 200, 255}});
    assets.materials.resize(1);
    assets.materials[0].wrinkle_texture.image = ImageId{0};
    world.insert_resource(std::move(assets));
    const auto warnings_with = [&](WrinkleMethod method) {
        const Entity skin = world.create(
            Name{"skin"}, MeshInstance{MeshId{0}, MaterialId{0}}, WrinkleSurface{.method = method});
        Warnings lines;
        for (const SceneWarning& warning : find_scene_warnings(world)) {
            lines.push_back(warning.text);
        }
        world.destroy(skin);
        return lines;
    };
    CHECK(warnings_with(WrinkleMethod::Bump).empty());
    CHECK(
        warnings_with(WrinkleMethod::Sphere)
        == Warnings{
            "entity \"skin\": wrinkle map \"mine\": found 2 of 2 x 2 texels with x^2 + y^2 > 0.6, "
            "which method sphere flattens by more than 8.76 degrees between its extremes; bump "
            "draws them as steep as they are"});
}

}  // namespace limn::scene_warnings_test
