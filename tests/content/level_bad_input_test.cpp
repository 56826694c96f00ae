// What must not be in a level, and what is said about it: one line with file, place, what was found
// and what was expected; the world stays as it was.

#include "content/load/level/level_load.h"
#include "content/load/scene_load.h"
#include "ecs/components/all.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace limn::level_bad_input_test {
namespace {

std::string error_of(std::string_view text, const LevelLimits& limits = {}) {
    register_all_components();
    const Result<Level> level = parse_level(text, "t.level.json", limits);
    REQUIRE_MESSAGE(!level.ok(), text);
    const std::string message = level.error().message;
    CHECK(message.starts_with("t.level.json:"));
    CHECK(message.find('\n') == std::string::npos);
    CHECK(message.find("found") != std::string::npos);
    CHECK(message.find("expected") != std::string::npos);
    return message;
}

/// Of a level file with this text, through load_scene; the world must stay empty.
std::string scene_error_of(const test::TemporaryFolder& folder, const std::string& text) {
    const std::string path = folder.file("t.level.json");
    std::ofstream(path) << text;
    World world;
    const Result<LoadedScene> scene = load_scene(world, path);
    REQUIRE_MESSAGE(!scene.ok(), text);
    CHECK(world.entity_count() == 0);
    CHECK(world.resources().empty());
    CHECK(scene.error().message.find('\n') == std::string::npos);
    return scene.error().message;
}

bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("bad level: the error for a misplaced or misnamed key says where it belongs") {
    const struct {
        const char* level;
        const char* message;
    } kCases[] = {
        {R"({"environment": {}})", R"("environment" is a resource: it belongs in "resources")"},
        {R"({"spot_light": {}})", R"("spot_light" is a component: it belongs on an entity)"},
        {R"({"resources": {"spin": {}}})", R"("spin" is a component: it belongs on an entity)"},
        {R"({"entities": [{"glow": {}}]})", R"("glow" is a resource: it belongs in "resources")"},
        {R"({"entities": [{"point_light": {"transform": {}}}]})",
         R"("transform" is a component: it belongs on an entity, beside its other components)"},
        {R"({"entities": [{"name": "a", "parent": "b"}]})",
         R"(found the key "parent", expected the entity in the list "children" of its parent)"},
        {R"({"entities": [{"name": "a", "repeat": {"count": [2, 1, 2], "spaceing": [1, 1, 1]}}]})",
         "(did you mean spacing?)"},
        {R"({"meshes": {"m": {"make": "bxo"}}})",
         "expected one of arch bar boat body_part boulder box"},
        {R"({"meshes": {"m": {}}})", R"("make": one of arch bar boat body_part boulder box)"},
        {R"({"images": {"i": {"make": "wod"}}})", "expected one of "},
        {R"({"events": [{"time": 1}]})",
         R"(found the key "time", expected "at": seconds since the start of the level)"},
        {R"({"events": [{"at": "2kg"}]})",
         R"(events[0].at: found the string "2kg", expected a number 0 .. 1000000 s or a string )"
         R"(like "45ms")"},
        {R"({"events": [{"at": "-2s"}]})", R"(found the string "-2s", expected a number 0)"},
        {R"({"events": [{"at": 1, "set": "a.spin"}]})",
         R"(expected {"entity": {"component": {"field": value}}})"},
        {R"({"events": [{"at": 1, "set": {"glow": {"amount": 1}}}]})",
         R"("glow" is a resource: use "set_resources")"},
        {R"({"events": [{"at": 1, "set_resources": {"spin": {"speed": 1}}}]})",
         R"("spin" is a component: it belongs on an entity)"},
        {R"({"paths": {"way": {"knots": [{"position": [0, 0, 0]}, {"position": [1, 0, 0]}]}},
             "entities": [{"path_follower": {"path": "wya"}}]})",
         "2:54: entities[0]: path_follower.path: found the path \"wya\", expected an existing name "
         "(did you mean way?)"},
        {R"({"entities": [{"position": [0, 1, 0]}]})",
         R"(one of name prefab gltf variant nodes repeat children ("position" is a field of look_at or reach_goal or transform))"},
        {R"({"entities": [{"rotation": [0, 1, 0]}]})", R"(("rotation" is a field of transform))"},
        {R"({"entities": [{"intensity": 3}]})",
         R"(("intensity" is a field of particle_light or point_light or spot_light))"},
        {R"({"entities": [{"point_light": {"fov_y": 1}}]})", R"(("fov_y" is a field of camera))"},
        {R"({"resources": {"ev": 1}})", R"(("ev" is a field of exposure))"},
        {R"({"entities": [{"point_light": {"color": "ornage"}}]})",
         R"(expected [r, g, b], "#rrggbb", "#rgb" or a name such as "orange" (did you mean orange?))"},
        {R"({"materials": {"m": {"base_color": [1, 1]}}})",
         R"(expected [r, g, b], [r, g, b, a], "#rrggbb", "#rrggbbaa" or a name such as "orange")"},
        {R"({"materials": {"m": {"pattern": "leaf.png"}}})",
         R"(expected the name of a generated image in "images" (for a file write )"
         R"("base_color_texture": {"image": "leaf"}, and "leaf": {"file": "leaf.png"} in "images"))"},
        {R"({"images": {"leaf": {"file": "leaf.png"}}, "materials": {"m": {"pattern": "leaf"}}})",
         R"((for a single image write "base_color_texture": {"image": "leaf"}))"},
        {R"({"entities": [{"name": "sun"},
                          {"name": "eye", "autofocus": {"target": "snu"}}]})",
         "2:67: entity \"eye\": autofocus.target: found the entity \"snu\", expected an existing "
         "name (did you mean sun?)"},
        {"{\"entities\": [\n{\"name\": \"a\"},\n{\"name\": \"a\"}]}",
         "3:10: entity \"a\": found a duplicate name \"a\", expected each name once (the first is "
         "in line 2)"},
    };
    for (const auto& [level, message] : kCases) {
        const std::string error = error_of(level);
        CHECK_MESSAGE(has(error, message), error);
    }
    // Names that files define are resolved when all files are read.
    const test::TemporaryFolder folder;
    CHECK(
        has(scene_error_of(folder, "{\"entities\": [\n{\"clip_player\": {\"clip\": \"Run\"}}]}"),
            "t.level.json:2:26: entity 0: clip_player: found the clip \"Run\""));
    std::ofstream(folder.file("Fox.glb")) << "";
    CHECK(
        has(scene_error_of(folder, R"({"entities": [{"gltf": "fox.glb"}]})"),
            "\"fox.glb\": no such file in " + std::filesystem::canonical(folder.path()).string()
                + " (did you mean Fox.glb?)"));
}

TEST_CASE("bad level: names that exist are suggested even beside an error") {
    register_all_components();
    const Result<Level> level = parse_level(
        R"({"paths": {"way": {"knots": [{}]}},
            "images": {"stone": {"make": "noise", "size": -1}},
            "materials": {"wall": {"base_color_texture": {"image": "stone.base_color"}}},
            "prefabs": {"car": {"path_follower": {"path": "waay"}}},
            "entities": [{"name": "a", "prefab": "car"}]})",
        "t.level.json");
    REQUIRE_FALSE(level.ok());
    const std::string& message = level.error().message;
    CHECK(has(message, "found the path \"waay\", expected an existing name (did you mean way?)"));
    CHECK_FALSE(has(message, "wall"));
    CHECK(std::count(message.begin(), message.end(), '\n') == 2);
}

TEST_CASE("bad level: missing files and bad copies are reported beside unknown prefabs") {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("t.level.json");
    std::ofstream(path) << R"({"images": {"sky": {"file": "sky.exr"}}, "entities": [
        {"name": "a", "prefab": "none", "gltf": "a.glb", "repeat": {"count": [0, 1, 1], "vary": {
          "spin.speed": {"from": 0, "to": 1}}}}]})";
    World world;
    const Result<LoadedScene> scene = load_scene(world, path);
    REQUIRE_FALSE(scene.ok());
    const std::string& message = scene.error().message;
    CHECK(has(message, "found the prefab \"none\""));
    CHECK(has(message, "repeat.count[0]: found the number 0"));
    CHECK(has(message, "\"a.glb\": no such file"));
    CHECK(has(message, "\"sky.exr\": no such file"));
    CHECK(std::count(message.begin(), message.end(), '\n') == 3);
}

TEST_CASE("bad level: all unknown clips, skins and skeletons are reported in one run") {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("t.level.json");
    std::ofstream(path) << "{\"entities\": [\n{\"clip_player\": {\"clip\": \"Run\"}},\n"
                           "{\"skeleton\": {\"skeleton\": \"bones\"}, "
                           "\"deformed\": {\"skin\": \"hide\"}}]}";
    World world;
    const Result<LoadedScene> scene = load_scene(world, path);
    REQUIRE_FALSE(scene.ok());
    const std::string& message = scene.error().message;
    CHECK(std::count(message.begin(), message.end(), '\n') == 2);
    CHECK(has(message, "t.level.json:2:26: entity 0: clip_player: found the clip \"Run\""));
    CHECK(has(message, "t.level.json:3:27: entity 1: skeleton: found the skeleton \"bones\""));
    CHECK(has(message, "t.level.json:3:58: entity 1: deformed: found the skin \"hide\""));
    CHECK(world.entity_count() == 0);
}

TEST_CASE("bad level: a missing file, a directory, an empty file, a syntax error") {
    const test::TemporaryFolder folder;
    World world;
    CHECK(has(load_scene(world, folder.file("no.level.json")).error().message, "no such file"));
    CHECK(has(load_scene(world, folder.path() + "/").error().message, "found a folder"));
    CHECK(has(load_scene(world, "no-such-level").error().message, "no level of that name"));
    CHECK(has(load_scene(world, folder.file("no.glb")).error().message, "no.glb"));
    CHECK(world.entity_count() == 0);
    CHECK(has(scene_error_of(folder, ""), "t.level.json:1:1: found the end of the file"));
    CHECK(
        has(scene_error_of(folder, "{\n  \"title\": \"a\"\n  \"entities\": []\n}"),
            "t.level.json:3:3: found \"\\\"\", expected ',' or '}'"));
    CHECK(has(scene_error_of(folder, "[]"), "expected a level (an object)"));
    CHECK(has(scene_error_of(folder, "\x89PNG\r\n"), "found"));
}

TEST_CASE("bad level: unknown keys, components, fields and names, with the nearest") {
    CHECK(
        error_of(R"({"entites": []})")
        == "t.level.json:1:2: found the key \"entites\", expected one of title description "
           "include resources images materials paths meshes motion_graphs prefabs entities events "
           "bindings shows $schema (did you mean entities?)");
    const std::string component =
        error_of("{\"entities\": [\n  {\"name\": \"lamp\", \"point_ligth\": {}}]}");
    CHECK(component.starts_with("t.level.json:2:20: entity \"lamp\": found the component "
                                "\"point_ligth\", expected one of"));
    CHECK(component.ends_with("(did you mean point_light?)"));
    const std::string field = error_of(R"({"entities": [{"point_light": {"intensty": 3}}]})");
    CHECK(field.starts_with("t.level.json:1:32: entities[0]: point_light: found the field "
                            "\"intensty\", expected one of"));
    CHECK(field.ends_with("(did you mean intensity?)"));
    CHECK(has(error_of(R"({"entities": [{"chidlren": []}]})"), "(did you mean children?)"));
    CHECK(has(error_of(R"({"resources": {"exposre": {}}})"), "(did you mean exposure?)"));
    CHECK(
        has(error_of(R"({"resources": {"environment": {"sky": "panorama"}}})"),
            "found a panorama sky without the image"));
    CHECK(
        has(error_of(
                R"({"images": {"dusk": {"file": "dusk.exr"}},
                    "resources": {"environment": {"sky": "panorama", "panorama": "dsk"}}})"),
            "(did you mean dusk?)"));
    CHECK(has(error_of(R"({"meshes": {"a": {"make": "teapto"}}})"), "(did you mean teapot?)"));
    CHECK(has(error_of(R"({"images": {"a": {"make": "marbel"}}})"), "(did you mean marble?)"));
    CHECK(has(
        error_of(R"({"materials": {"gold": {}, "b": {"like": "glod"}}})"), "(did you mean gold?)"));
    CHECK(
        has(error_of(
                R"({"images": {"oak": {"make": "wood"}}, "materials": {"b": {"pattern": "aok"}}})"),
            "(did you mean oak?)"));
    CHECK(has(
        error_of(
            R"({"materials": {"gold": {}}, "entities": [{"mesh_instance": {"material": "godl"}}]})"),
        "(did you mean gold?)"));
    CHECK(
        has(error_of(R"({"prefabs": {"lamp": {}}, "entities": [{"prefab": "lmap"}]})"),
            "(did you mean lamp?)"));
    const std::string entity =
        error_of(R"({"entities": [{"name": "sun"}, {"orbit_camera": {"target": "snu"}}]})");
    CHECK(entity.starts_with("t.level.json:1:60: entity 1: orbit_camera.target: found the entity "
                             "\"snu\""));
    CHECK(entity.ends_with("(did you mean sun?)"));
    CHECK(has(
        error_of(R"({"entities": [{"mesh_instance": {"mesh": "a"}}]})"), "no names of that kind"));
}

TEST_CASE("bad level: independent errors are reported together, ten and how many more") {
    register_all_components();
    const auto lines_of = [](const std::string& text) {
        const Result<Level> level = parse_level(text, "t.level.json");
        REQUIRE_FALSE(level.ok());
        std::istringstream message(level.error().message);
        std::vector<std::string> lines;
        for (std::string line; std::getline(message, line);) {
            lines.push_back(line.substr(0, line.find(": ")));
        }
        return lines;
    };
    using Lines = std::vector<std::string>;
    CHECK(
        lines_of(R"({"resources": {"exposure": {"evv": 1}},
                     "prefabs": {"lamp": {"point_light": {"intensity": -1}}},
                     "entities": [
{"spinn": {}},
{"prefab": "lamp"}, {"prefab": "lamp"},
{"name": "a"}, {"name": "b", "camera": {"fov": 1}}]})")
        == Lines{
            "t.level.json:1:29", "t.level.json:4:2", "t.level.json:2:72", "t.level.json:6:41"});
    CHECK(
        lines_of(R"({"materials": {"a": {"rough": 1}, "b": {"like": "a"}, "c": {"metal": 1}},
                     "entities": [{"mesh_instance": {"material": "a"}}]})")
        == Lines{"t.level.json:1:22", "t.level.json:1:61"});
    CHECK(
        lines_of(R"({"events": [{"at": -1}, {"at": 2}, {"at": "soon"}]})")
        == Lines{"t.level.json:1:20", "t.level.json:1:43"});
    // What names something that has an error has none itself.
    CHECK(
        lines_of(R"({"images": {"oak": {"make": "wod"}},
"materials": {"m": {"pattern": "oak"}, "n": {"like": "o"}, "o": {"rough": 1}, "p": {"base_color_texture": {"image": "oak"}}},
"meshes": {"b": {"make": "bxo"}}, "paths": {"w": {"knots": 3}},
"entities": [{"mesh_instance": {"mesh": "b", "material": "o"}, "path_follower": {"path": "w"}},
{"mesh_instance": {"mesh": "c"}}]})")
        == Lines{
            "t.level.json:1:29", "t.level.json:2:66", "t.level.json:3:60", "t.level.json:3:26",
            "t.level.json:5:28"});
    CHECK(
        lines_of(R"({"prefabs": {"unused": {"spinn": {}}},
"entities": [{"autofocus": {"target": "nobody"}}],
"events": [{"at": 1, "destroy": ["nobody"]}]})")
        == Lines{"t.level.json:2:39", "t.level.json:3:34", "t.level.json:1:25"});
    // Errors of entities hide neither each other, in one entity or in several, nor later sections.
    CHECK(
        lines_of(R"({"titel": "x", "entities": [
{"name": "a", "spinn": {}, "camera": {"fov": 1}, "children": [{"name": "b", "lod": {"x": 1}}]},
{"autofocus": {"target": "nobody"}}, {"autofocus": {"target": "noone"}}],
"events": [{"at": -1}, {"at": 1, "destroy": ["a", "b"]}],
"shows": [{"technique": "x", "text": "y"}]})")
        == Lines{
            "t.level.json:1:2", "t.level.json:2:15", "t.level.json:2:39", "t.level.json:2:77",
            "t.level.json:4:19", "t.level.json:5:11"});
    CHECK(
        lines_of(R"({"entities": [{"autofocus": {"target": "nobody"}},
{"autofocus": {"target": "noone"}}], "events": [{"at": 1, "destroy": ["neither"]}]})")
        == Lines{"t.level.json:1:40", "t.level.json:2:26", "t.level.json:2:71"});
    CHECK(
        lines_of(R"({"entities": [{"name": "a", "prefab": "none", "children": [{"name": "c"}]},
{"name": "b", "repeat": {"cuont": 3}}, {"autofocus": {"target": "b[1]"}}],
"events": [{"at": 1, "destroy": ["a", "c", "d"]}]})")
        == Lines{"t.level.json:1:39", "t.level.json:2:26", "t.level.json:3:44"});
    const auto last_line_of = [](std::size_t errors) {
        std::string many = R"({"entities": [3)";
        for (std::size_t i = 1; i < errors; ++i) {
            many += ", 3";
        }
        register_all_components();
        const std::string message = parse_level(many + "]}", "t.level.json").error().message;
        CHECK(std::count(message.begin(), message.end(), '\n') == (errors > 10 ? 10 : 9));
        return message.substr(message.rfind('\n') + 1);
    };
    CHECK(last_line_of(10).starts_with("t.level.json:1:42: entities[9]: found the number 3"));
    CHECK(last_line_of(11) == "t.level.json: and 1 more");
    CHECK(last_line_of(50) == "t.level.json: and 40 more");
    CHECK(last_line_of(5000) == "t.level.json: and at least 990 more");
}

TEST_CASE("bad level: wrong types and numbers out of range") {
    for (
        const char* text :
        {R"({"title": 3})",
         R"({"resources": []})",
         R"({"resources": {"exposure": 1}})",
         R"({"images": {"a": 3}})",
         R"({"images": {"a": {"make": 3}}})",
         R"({"images": {"a": {"make": "wood", "file": "x"}}})",
         R"({"images": {"a": {"file": 3}}})",
         R"({"images": {"a": {"file": "x.png", "srgb": 1}}})",
         R"({"images": {"a": {"file": "x.png", "size": 1}}})",
         R"({"images": {"a": {"make": "wood", "size": 0}}})",
         R"({"images": {"a": {"make": "wood", "size": 5000}}})",
         R"({"materials": {"a": {"roughness": 2}}})",
         R"({"materials": {"a": {"like": "a"}}})",
         R"({"materials": {"a": {"tiling": 3}}})",
         R"({"meshes": {"a": {}}})",
         R"({"meshes": {"a": {"make": "sphere", "rings": 1}}})",
         R"({"meshes": {"a": {"make": "sphere", "rings": 2.5}}})",
         R"({"prefabs": []})",
         R"({"prefabs": {"a": 3}})",
         R"({"entities": {}})",
         R"({"entities": [3]})",
         R"({"entities": [{"name": ""}]})",
         R"({"entities": [{"name": "a.b"}]})",
         R"({"entities": [{"name": 3}]})",
         R"({"entities": [{"prefab": 3}]})",
         R"({"entities": [{"children": {}}]})",
         R"({"entities": [{"gltf": 3}]})",
         R"({"entities": [{"transform": []}]})",
         R"({"entities": [{"transform": {"position": [1, 2]}}]})",
         R"({"entities": [{"transform": {"position": [1, 2, 1e39]}}]})",
         R"({"entities": [{"transform": {"scale": [1, 1, 0]}}]})",
         R"({"entities": [{"point_light": {"intensity": -1}}]})",
         R"({"entities": [{"point_light": {"attenuation": {"falloff": "cubic"}}}]})",
         R"({"entities": [{"parent": {}}]})",
         R"({"events": {}})",
         R"({"events": [3]})",
         R"({"events": [{}]})",
         R"({"events": [{"at": -1}]})",
         R"({"events": [{"at": "soon"}]})",
         R"({"events": [{"at": 1, "times": 3}]})",
         R"({"events": [{"at": 1, "every": 0, "times": 3}]})",
         R"({"events": [{"at": 1, "every": 1, "times": 1.5}]})",
         R"({"events": [{"at": 1, "set": []}]})",
         R"({"events": [{"at": 1, "set": {"nobody": {}}}]})",
         R"({"events": [{"at": 1, "destroy": ["nobody"]}]})",
         R"({"events": [{"at": 1, "destroy": [3]}]})",
         R"({"events": [{"at": 1, "spawn": {}}]})",
         R"({"events": [{"at": 1, "spawn": [{"gltf": "a.glb"}]}]})",
         R"({"events": [{"at": 1, "jump": 1}]})",
         R"({"events": [{"at": 1, "set_resources": {"exposure": {"evv": 1}}}]})",
         R"({"entities": [{"name": "a"}], "events": [{"at": 1, "impulse": {"a": {"camera": {"active": true}}}}]})",
         R"({"events": [{"at": 1, "impulse_resources": {"exposure": {"curve": "aces"}}}]})",
         R"({"events": [{"at": 1, "impulse_resources": {"exposure": {"curve": 0.5}}}]})",
         R"({"events": [{"at": 1, "impulse_resources": {"exposure": {"curve": 0}}}]})",
         R"({"entities": [{"name": "a"}], "events": [{"at": 1, "set": {"a": {"spinn": {}}}}]})"}) {
        CAPTURE(text);
        CHECK_FALSE(error_of(text).empty());
    }
    CHECK(
        has(error_of(R"({"entities": [{"name": "x", "point_light": {"intensity": 1e9}}]})"),
            "entity \"x\": point_light.intensity: found the number 1e9, expected a number 0 .. "
            "1000000 cd"));
}

TEST_CASE("bad level: repetitions that make no sense") {
    const auto repeat_error = [](const std::string& repeat) {
        return error_of(
            R"({"entities": [{"spin": {}, "mesh_instance": {}, "repeat": )" + repeat + "}]}");
    };
    for (const char* text :
         {"3",
          R"({"cuont": [1, 1, 1]})",
          R"({"count": [0, 1, 1]})",
          R"({"count": [1, 1]})",
          R"({"jitter": [-1, 0, 0]})",
          R"({"vary": []})",
          R"({"vary": {"spin": {"from": 0, "to": 1}}})",
          R"({"vary": {"": {"from": 0, "to": 1}}})",
          R"({"vary": {"sway.phase": {"from": 0, "to": 1}}})",
          R"({"vary": {"spin.sped": {"from": 0, "to": 1}}})",
          R"({"vary": {"spin.speed": 3}})",
          R"({"vary": {"spin.speed": {}}})",
          R"({"vary": {"spin.speed": {"from": 0}}})",
          R"({"vary": {"spin.speed": {"from": 0, "to": 1, "pick": [1]}}})",
          R"({"vary": {"spin.speed": {"from": 0, "to": 1e9}}})",
          R"({"vary": {"spin.speed": {"pick": []}}})",
          R"({"vary": {"spin.speed": {"pick": ["a"]}}})",
          R"({"vary": {"spin.speed": {"by": "colour", "pick": [1]}}})",
          R"({"vary": {"spin.speed": {"pick": [1], "noise": 2}}})",
          R"({"vary": {"spin.speed": {"pick": [1], "times": 0}}})",
          R"({"vary": {"spin.speed": {"pik": [1]}}})",
          R"({"vary": {"mesh_instance.mesh": {"from": "a", "to": "b"}}})",
          R"({"vary": {"transform.rotation": {"from": [0, 0, 0, 1], "to": [0, 0, 0]}}})"}) {
        CAPTURE(text);
        CHECK_FALSE(repeat_error(text).empty());
    }
    CHECK(has(
        repeat_error(R"({"vary": {"spin.sped": {"from": 0, "to": 1}}})"), "(did you mean speed?)"));
}

TEST_CASE("bad level: a prefab inside itself, at any distance, used or not") {
    CHECK(has(
        error_of(R"({"prefabs": {"a": {"prefab": "a"}}, "entities": [{"prefab": "a"}]})"),
        "found the prefab \"a\" inside itself (a > a), expected one that does not contain itself"));
    CHECK(has(
        error_of(
            R"({"prefabs": {"a": {"children": [{"prefab": "b"}]}, "b": {"children": [{"prefab": "a"}]}}})"),
        "(a > b > a)"));
    CHECK(has(
        error_of(
            R"({"prefabs": {"a": {"prefab": "b"}, "b": {"children": [{"children": [{"prefab": "a"}]}]}}})"),
        "inside itself"));
    CHECK(
        has(error_of(R"({"prefabs": {"a": {"name": "x"}}, "entities": [{"prefab": "a"}]})"),
            "prefabs.a: found a name"));
    CHECK(has(error_of(R"({"prefabs": {"never used": {"spinn": {}}}})"), "(did you mean spin?)"));
}

TEST_CASE("bad level: names given twice") {
    CHECK(
        has(error_of(R"({"entities": [{"name": "a"}, {"children": [{"name": "a"}]}]})"),
            "found a duplicate name \"a\""));
    CHECK(has(error_of(R"({"materials": {"a": {}, "a": {}}})"), "found a duplicate key \"a\""));
}

TEST_CASE("bad level: what would grow without bound is refused before it does") {
    CHECK(
        has(error_of(R"({"entities": [{"repeat": {"count": [1000000, 1000000, 1000000]}}]})"),
            "entities here"));
    CHECK(has(
        error_of(
            R"({"entities": [{"repeat": {"count": [2000, 1, 1]}, "children": [{"repeat": {"count": [2000, 1, 1]}}]}]})"),
        "at most 2000000 in all"));
    // Ten prefabs that each hold ten of the next: a billion entities in a few lines.
    std::string bomb = R"({"prefabs": {"p10": {})";
    for (int i = 0; i < 10; ++i) {
        bomb += ", \"p" + std::to_string(i) + "\": {\"children\": [";
        for (int j = 0; j < 10; ++j) {
            bomb += (j > 0 ? ", " : "") + std::string("{\"prefab\": \"p") + std::to_string(i + 1)
                    + "\"}";
        }
        bomb += "]}";
    }
    CHECK(
        has(error_of(bomb + "}}", {.entities = {.max_entities = 10'000}}), "at most 10000 in all"));
    // Large values, often repeated.
    std::string large = R"({"entities": [{"camera_path": {"keys": [{"time": 0})";
    for (int i = 1; i < 1000; ++i) {
        large += ", {\"time\": " + std::to_string(i) + "}";
    }
    CHECK(
        has(error_of(
                large + R"(]}, "repeat": {"count": [1000, 1, 1]}}]})",
                {.entities = {.max_values = 100'000}}),
            "copies of"));
    std::string many = R"({"entities": [{"spin": {}})";
    for (int i = 0; i < 1000; ++i) {
        many += R"(, {"spin": {"axis": [0, 1, 0], "speed": 1}})";
    }
    CHECK(has(error_of(many + "]}", {.entities = {.max_values = 5'000}}), "copies of"));
    // Deeper than the stack is.
    std::string deep = R"({"prefabs": {"p0": {})";
    for (int i = 1; i < 5000; ++i) {
        deep += ", \"p" + std::to_string(i) + "\": {\"children\": [{\"prefab\": \"p"
                + std::to_string(i - 1) + "\"}]}";
    }
    CHECK(has(error_of(deep + "}, \"entities\": [{\"prefab\": \"p4999\"}]}"), "nested entities"));
    std::string chain = R"({"prefabs": {"p0": {})";
    for (int i = 1; i < 5000; ++i) {
        chain +=
            ", \"p" + std::to_string(i) + "\": {\"prefab\": \"p" + std::to_string(i - 1) + "\"}";
    }
    CHECK(has(
        error_of(chain + "}, \"entities\": [{\"prefab\": \"p4999\"}]}"), "a chain of more than"));
}

TEST_CASE("bad level: too many pixels or vertices are refused") {
    register_all_components();
    Result<Level> level =
        parse_level(R"({"images": {"a": {"make": "wood", "size": 64}}})", "t.level.json");
    REQUIRE(level.ok());
    CHECK(
        has(load_level_assets(*level, "", {.max_pixels = 1000}).error().message,
            "found 12288 pixels, expected at most 1000"));
    level = parse_level(
        R"({"images": {"a": {"make": "wood", "size": 16}, "b": {"make": "wood", "size": 16}}})",
        "t.level.json");
    REQUIRE(level.ok());
    CHECK(
        has(load_level_assets(*level, "", {.max_pixels = 1000}).error().message,
            "images.b: found 768 pixels, expected at most 232"));
    level = parse_level(R"({"meshes": {"a": {"make": "sphere"}}})", "t.level.json");
    REQUIRE(level.ok());
    CHECK(
        has(load_level_assets(*level, "", {.max_vertices = 100}).error().message,
            "expected at most 100"));
}

TEST_CASE("bad level: files outside its folder, missing and corrupt ones") {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("inner"));
    std::ofstream(folder.file("broken.png")) << "no picture";
    std::ofstream(folder.file("broken.glb")) << "glTF";
    std::ofstream(folder.file("secret.png")) << "x";
    for (const char* name :
         {"../secret.png", "/etc/passwd", "http://example.org/a.png", "file:///etc/passwd",
          "inner/../../x.png", "..", "", "none.png", "broken.png", "inner"}) {
        CAPTURE(name);
        const std::string image = scene_error_of(
            folder, R"({"images": {"a": {"file": ")" + std::string(name) + R"("}}})");
        CHECK(has(image, "t.level.json:1:18: images.a"));
    }
    for (const char* name :
         {"../fox.glb", "/fox.glb", "http://example.org/fox.glb", "none.glb", "broken.glb",
          "inner"}) {
        CAPTURE(name);
        const std::string gltf =
            scene_error_of(folder, R"({"entities": [{"gltf": ")" + std::string(name) + R"("}]})");
        CHECK(has(gltf, name));
    }
    std::filesystem::create_symlink("/etc/passwd", folder.file("link.png"));
    CHECK(has(scene_error_of(folder, R"({"images": {"a": {"file": "link.png"}}})"), "link.png"));
}

TEST_CASE("bad level: the world keeps what it had when a later part fails") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("t.level.json")) << R"({
        "resources": {"exposure": {"ev": 5}}, "materials": {"m": {}}, "meshes": {"b": {"make": "box"}},
        "entities": [{"mesh_instance": {"mesh": "b", "material": "m"}}, {"gltf": "none.glb"}]})";
    World world;
    const Entity kept = world.create(Transform{.position = {1, 2, 3}});
    const Result<LoadedScene> scene = load_scene(world, folder.file("t.level.json"));
    REQUIRE_FALSE(scene.ok());
    CHECK(world.entity_count() == 1);
    CHECK(world.get<const Transform>(kept).position == Vec3(1, 2, 3));
    CHECK(world.resources().empty());
}

TEST_CASE("bad level: any cut of a good level, and any byte replaced, is read without harm") {
    register_all_components();
    const std::string good =
        R"({"resources": {"exposure": {"ev": 1}}, "materials": {"m": {"base_color": "#ff8000"}},
        "meshes": {"b": {"make": "box"}}, "prefabs": {"p": {"spin": {"speed": 1}, "children": [{"name": "c"}]}},
        "entities": [{"name": "a", "prefab": "p", "orbit_camera": {"target": "c"}, "mesh_instance": {"mesh": "b", "material": "m"},
        "repeat": {"count": [2, 1, 2], "vary": {"spin.speed": {"from": 0, "to": 1}}}}],
        "events": [{"at": 1, "every": 2, "times": 3, "spawn": [{"prefab": "p"}], "set_resources": {"exposure": {"ev": 2}}}]})";
    REQUIRE(parse_level(good, "t.level.json").ok());
    const LevelLimits small = {.entities = {.max_entities = 1000, .max_values = 100'000}};
    int refused = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
        refused += parse_level(good.substr(0, i), "t.level.json", small).ok() ? 0 : 1;
        for (const char c : {'"', '{', ']', '9', '-', '\0', '\xff'}) {
            std::string changed = good;
            changed[i] = c;
            const Result<Level> level = parse_level(changed, "t.level.json", small);
            if (!level) {
                CHECK(level.error().message.starts_with("t.level.json:"));
            }
        }
    }
    CHECK(refused == static_cast<int>(good.size()));
}

}  // namespace limn::level_bad_input_test
