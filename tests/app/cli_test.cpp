#include "content/load/files/json_document.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>

namespace limn::cli_test {

using test::count_lines;
using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;

namespace {

using Words = std::vector<std::string>;

std::string joined(const Words& words) {
    std::string line = "limn";
    for (const std::string& word : words) {
        line += " " + word;
    }
    return line;
}

/// The run failed with `code`, said why in one line, and printed nothing else.
void check_fails(
    const TemporaryFolder& folder, const Words& words, int code, const char* says = "") {
    const ProgramRun run = run_limn(folder, words);
    CAPTURE(joined(words));
    CAPTURE(run.err);
    CHECK(run.exit_code == code);
    CHECK(count_lines(run.err) == 1);
    CHECK(run.err.find(says) != std::string::npos);
    CHECK(run.out.empty());
}

}  // namespace

TEST_CASE("cli: without arguments it prints a short help") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {});
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("render") != std::string::npos);
    CHECK(run.out.find("components") != std::string::npos);
    CHECK(count_lines(run.out) < 32);
    CHECK(run.err.empty());
}

TEST_CASE("cli: help is a command, too, also of one command") {
    const TemporaryFolder folder;
    CHECK(run_limn(folder, {"help"}).out == run_limn(folder, {}).out);
    const ProgramRun run = run_limn(folder, {"help", "bake"});
    CHECK(run.exit_code == 0);
    CHECK(run.out == run_limn(folder, {"bake", "--help"}).out);
}

TEST_CASE("cli: --version names the program and its version") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"--version"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.starts_with("limn 0."));
}

TEST_CASE("cli: every command has help with an example") {
    const TemporaryFolder folder;
    for (const char* command :
         {"play", "render", "bench", "hash", "quality", "compare", "bake", "info", "import", "make",
          "export", "speak", "levels", "shows", "components"}) {
        const ProgramRun run = run_limn(folder, {command, "--help"});
        CAPTURE(command);
        CHECK(run.exit_code == 0);
        CHECK(run.out.find("Example") != std::string::npos);
        CHECK(run.out.find(std::string("limn ") + command) != std::string::npos);
    }
}

TEST_CASE("cli: wrong usage exits with 2 and one line that names the mistake") {
    const TemporaryFolder folder;
    std::ofstream(folder.file("mine.level.json")) << "{}";
    check_fails(folder, {"check", "mine"}, 1, "(did you mean mine.level.json?)");
    check_fails(folder, {"rendr"}, 2, "render");
    check_fails(folder, {"--what"}, 2);
    check_fails(folder, {"render"}, 2, "--out");
    check_fails(folder, {"render", "-o", "a.png"}, 2, "SCENE or --show");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--off"}, 2, "--show ID");
    check_fails(folder, {"render", "gallery"}, 2, "--out");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--size", "640"}, 2, "640");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--size", "0x360"}, 2, "0x360");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--frames", "5:2"}, 2, "5:2");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--frames", "0:9"}, 2, "%04d");
    check_fails(folder, {"render", "gallery", "-o", "a%04d.png"}, 2, "--frames");
    check_fails(folder, {"render", "gallery", "-o", "a%s.png", "--frames", "0:9"}, 2, "%04d");
    check_fails(folder, {"render", "gallery", "-o", "a.bmp"}, 2, ".png");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--time", "nan"}, 2, "nan");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--time", "-1"}, 2, "-1");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--spp", "0"}, 2, "0");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--fps", "0"}, 2, "0");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--set", "exposure"}, 2, "exposure");
    check_fails(folder, {"render", "gallery", "-o", "a.png", "--aov", "depth"}, 2, ".exr");
    check_fails(folder, {"render", "gallery", "-o", "a.exr", "--aov", "dept"}, 2, "depth");
    check_fails(folder, {"bench", "gallery", "--frames", "0"}, 2, "--frames");
    check_fails(folder, {"bench", "particles", "--only", "draft"}, 2, "draw");
    check_fails(folder, {"bench", "faces", "--only", "draft"}, 2, "pixels");
    check_fails(folder, {"bench", "characters", "--only", "draft"}, 2, "chain");
    check_fails(folder, {"bench", "gallery", "--only", "draw"}, 2, "particles");
    check_fails(folder, {"quality", "--what"}, 2, "--what");
    check_fails(folder, {"film", "a.png", "-o", "a.mp4"}, 2, "%04d");
    check_fails(folder, {"film", "a_%d.png", "-o", "a.avi"}, 2, ".mp4");
    check_fails(folder, {"hash", "gallery"}, 2, "--frames");
    check_fails(folder, {"hash", "gallery", "--frames", "two"}, 2, "two");
    check_fails(folder, {"hash", "gallery", "--frames", "2", "--threads", "0"}, 2, "--threads");
    check_fails(folder, {"compare", "a.png"}, 2);
    check_fails(folder, {"compare", "a.png", "b.png", "--diff", "d.exr"}, 2, "d.exr");
    check_fails(folder, {"play", "--scale", "big"}, 2, "auto");
    check_fails(folder, {"play", "--headless-frames", "0"}, 2, "--headless-frames");
    check_fails(folder, {"info"}, 2, "file");
    check_fails(folder, {"view"}, 2, "file");
    check_fails(folder, {"view", "a.exr", "-o", "a.exr"}, 2, ".png");
    check_fails(folder, {"view", "a.exr", "--ev", "300"}, 2, "300");
    check_fails(folder, {"view", "a.exr", "--ev", "nan"}, 2, "nan");
    check_fails(folder, {"view", "a.exr", "--curve", "filmic"}, 2, "neutral");
    check_fails(folder, {"view", "a.exr", "--gamma", "0"}, 2, "--gamma");
}

TEST_CASE("cli: for a scene that cannot be loaded, every command exits with 1 and one line") {
    const TemporaryFolder folder;
    test::write_text(folder.file("empty.glb"), "");
    test::write_text(folder.file("empty.gltf"), "");
    test::write_text(folder.file("empty.level.json"), "");
    test::write_text(folder.file("junk.glb"), "this is no GLB file at all, is it");
    std::filesystem::create_directory(folder.file("folder.glb"));
    for (const char* scene :
         {"missing.glb", "missing.level.json", "folder.glb", "empty.glb", "empty.gltf",
          "empty.level.json", "junk.glb", ".", "no-such-level"}) {
        check_fails(folder, {"render", scene, "-o", "a.png"}, 1, scene);
        check_fails(folder, {"hash", scene, "--frames", "1"}, 1, scene);
        check_fails(folder, {"info", scene}, 1, scene);
    }
    check_fails(folder, {"info", "."}, 1, "expected a file, as ./empty.glb ./empty.gltf");
    check_fails(folder, {"bench", "missing.glb", "--frames", "1"}, 1, "missing.glb");
    check_fails(folder, {"play", "missing.glb", "--headless-frames", "1"}, 1, "missing.glb");
    CHECK_FALSE(std::filesystem::exists(folder.file("a.png")));
}

TEST_CASE("cli: render reports its file in one line, and nothing with --quiet") {
    const TemporaryFolder folder;
    test::write_text(folder.file("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Words words = {"render", "a.obj", "-o", "a.png", "--size", "64x36"};
    const ProgramRun run = run_limn(folder, words);
    CHECK(run.exit_code == 0);
    CHECK(run.err.empty());
    CHECK(count_lines(run.out) == 1);
    CHECK(run.out.find("a.png: 64x36, ") == 0);
    CHECK(run.out.find(" s\n") != std::string::npos);
    const ProgramRun range = run_limn(
        folder, {"render", "a.obj", "-o", "a_%04d.png", "--size", "64x36", "--frames", "0:1"});
    CHECK(range.out.find("a_%04d.png: 2 x 64x36, ") == 0);
    CHECK(std::filesystem::exists(folder.file("a_0001.png")));
    Words quiet = words;
    quiet.push_back("--quiet");
    const ProgramRun silent = run_limn(folder, quiet);
    CHECK(silent.exit_code == 0);
    CHECK(silent.out.empty());
    CHECK(silent.err.empty());
}

TEST_CASE("cli: a model without a mesh gives one line") {
    const TemporaryFolder folder;
    test::write_text(
        folder.file("a.gltf"),
        R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{}]})");
    const ProgramRun run =
        run_limn(folder, {"render", "a.gltf", "-o", "a.png", "--size", "64x36", "--quiet"});
    CHECK(run.exit_code == 0);
    CHECK(run.err == "warning: a.gltf: found no mesh to draw, expected one\n");
}

TEST_CASE("cli: errors of a level are one line each, whatever characters its names contain") {
    const TemporaryFolder folder;
    test::write_text(
        folder.file("bad.level.json"),
        R"({"entities": [{"a\n\u001b[2J": 1}, {"mesh_instance": {"mesh": "b\nc"}}]})");
    for (const char* command : {"check", "info"}) {
        const ProgramRun run = run_limn(folder, {command, "bad.level.json"});
        CAPTURE(run.err);
        CHECK(run.exit_code == 1);
        CHECK(count_lines(run.err) == 2);
        CHECK(run.err.find("bad.level.json:1:16: ") == 0);
        CHECK(run.err.find("\nbad.level.json:1:") != std::string::npos);
        CHECK(run.err.find('\x1b') == std::string::npos);
    }
}

TEST_CASE("cli: for a misspelled level, the error suggests the right name") {
    const TemporaryFolder folder;
    check_fails(folder, {"hash", "galery", "--frames", "1"}, 1, "gallery");
}

TEST_CASE("cli: for images that cannot be read or compared, it exits with 1 and one line") {
    const TemporaryFolder folder;
    test::write_text(folder.file("empty.png"), "");
    check_fails(folder, {"compare", "missing.png", "missing.png"}, 1, "missing.png");
    check_fails(folder, {"compare", "empty.png", "empty.png"}, 1, "empty.png");
    check_fails(folder, {"compare", ".", "."}, 1);
}

TEST_CASE("cli: shows finds techniques by what graphics programmers call them") {
    const TemporaryFolder folder;
    const auto shows = [&](const Words& words) {
        Words all = {"shows"};
        all.insert(all.end(), words.begin(), words.end());
        const ProgramRun run = run_limn(folder, all);
        CHECK(run.exit_code == 0);
        return run.out;
    };
    CHECK(shows({"Bloom"}).find("limn play --show post.glow\n") != std::string::npos);
    const std::string lens = shows({"depth", "of", "field"});
    CHECK(lens.find("post.circle-of-confusion") != std::string::npos);
    CHECK(lens.find("post.dof-mip") != std::string::npos);
    CHECK(lens.find("post.glow") == std::string::npos);
    CHECK(shows({"clustered", "lighting"}).find("Shown by a command") != std::string::npos);
    CHECK(shows({"motion blur"}).find("post.motion-blur-reconstruct") != std::string::npos);
    CHECK(shows({"keys", "weights"}).find("wrinkle.maps.animation") != std::string::npos);
    CHECK(shows({"shadow.p"}).find("shadow.pcf") != std::string::npos);
    check_fails(folder, {"shows", "no", "such", "thing"}, 1, "\"no such thing\"");
}

TEST_CASE("cli: shows lists techniques with their levels, and how to show one") {
    const TemporaryFolder folder;
    const ProgramRun all = run_limn(folder, {"shows"});
    CHECK(all.exit_code == 0);
    CHECK(count_lines(all.out) > 100);
    CHECK(all.out.find("shadow.penumbra ") != std::string::npos);
    const ProgramRun one = run_limn(folder, {"shows", "shadow.penumbra"});
    CHECK(one.exit_code == 0);
    CHECK(one.out.find("contact_hardening") != std::string::npos);
    CHECK(one.out.find("limn render --show shadow.penumbra --off") != std::string::npos);
    check_fails(folder, {"shows", "shadow.penubra"}, 1, "did you mean shadow.penumbra?");
    CHECK(
        run_limn(folder, {"shows", "shadow.stencil-pass"}).out.find("On and off must look the same")
        != std::string::npos);
    check_fails(folder, {"render", "--show", "shadow.penumbr", "-o", "a.png"}, 1, "did you mean");
    check_fails(folder, {"render", "--show", "bloom", "-o", "a.png"}, 1, "`limn shows bloom`");
    check_fails(folder, {"render", "ocean", "--show", "shadow.pcf", "-o", "a.png"}, 1, "ocean");
    check_fails(folder, {"render", "a.glb", "--show", "shadow.pcf", "-o", "a.png"}, 1, "model");
}

TEST_CASE("cli: levels lists the gallery, components their fields with units") {
    const TemporaryFolder folder;
    const ProgramRun levels = run_limn(folder, {"levels"});
    CHECK(levels.exit_code == 0);
    CHECK(levels.out.find("gallery") != std::string::npos);

    const ProgramRun components = run_limn(folder, {"components"});
    CHECK(components.exit_code == 0);
    CHECK(components.out.find("point_light") != std::string::npos);
    CHECK(components.out.find("intensity") != std::string::npos);
    CHECK(components.out.find("1000000 cd") != std::string::npos);
    CHECK(components.out.find("[0, 0, 0]  m ") != std::string::npos);  // a unit without limits
    CHECK(components.out.find("\nocean\n") != std::string::npos);
    CHECK(components.out.find("\nocean_state\n") == std::string::npos);  // internal
    const ProgramRun all = run_limn(folder, {"components", "--all"});
    CHECK(all.out.find("ocean_state\n") > all.out.find("==== Internal components"));

    const ProgramRun schema = run_limn(folder, {"components", "--schema"});
    CHECK(schema.exit_code == 0);
    CHECK(schema.out.find("\"$schema\"") != std::string::npos);
    CHECK(schema.out.find("\"point_light\"") != std::string::npos);
}

TEST_CASE("cli: a program that was moved with its tree finds the levels there") {
    const TemporaryFolder folder;
    namespace fs = std::filesystem;
    fs::create_directories(folder.file("build/release"));
    fs::create_directories(folder.file("content/levels"));
    test::write_text(folder.file("content/levels/moved.level.json"), R"({"title": "Moved"})");
    const std::string program = folder.file("build/release/limn");
    fs::copy_file(LIMN_PROGRAM, program);
    test::Program moved(folder, {"levels"}, program);
    const ProgramRun run = moved.wait();
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("moved") != std::string::npos);
    CHECK(run.out.find("Moved") != std::string::npos);
}

TEST_CASE("cli: components NAME prints one type, as written in a level") {
    const TemporaryFolder folder;
    const auto printed = [&](const char* name) {
        const ProgramRun run = run_limn(folder, {"components", name});
        CAPTURE(name);
        CHECK(run.exit_code == 0);
        return run.out;
    };
    CHECK(printed("camera_path").starts_with("==== Components: of an entity\n\ncamera_path\n"));
    CHECK(printed("camera_path").find("keys[].look_at ") != std::string::npos);
    CHECK(printed("camera_path").find("orbit_camera") == std::string::npos);
    CHECK(printed("camera").find("angle, as \"45deg\"  = \"50deg\"") != std::string::npos);
    CHECK(printed("camera").find("177.6 deg ") != std::string::npos);
    CHECK(
        printed("transform").find("[yaw, pitch, roll] in degrees  = [0, 0, 0]")
        != std::string::npos);
    const std::string material = printed("material");
    const std::size_t slot = material.find("base_color_texture.image ");
    REQUIRE(slot != std::string::npos);
    CHECK(material.substr(slot, 90).find("  name of an image") != std::string::npos);
    CHECK(printed("box").find("\"meshes\"") != std::string::npos);
    CHECK(printed("wood").find("\"images\"") != std::string::npos);
    CHECK(printed("exposure").find("Resources") != std::string::npos);
    check_fails(folder, {"components", "point_ligth"}, 1, "(did you mean point_light?)");
    check_fails(folder, {"components", "box", "--schema"}, 2);
}

namespace {

/// Names of all properties of a JSON Schema, but those of internal types, which levels only read.
void find_properties(const JsonValue& schema, std::set<std::string>& names) {
    for (const JsonValue& item : schema.items) {
        find_properties(item, names);
    }
    for (const auto& [key, at, value] : schema.members) {
        if (key == "properties") {
            for (const auto& [property, position, its_schema] : value.members) {
                names.insert(property);
                find_properties(its_schema, names);
            }
        } else if (key != "default") {
            find_properties(value, names);
        }
    }
}

}  // namespace

TEST_CASE("cli: components lists every key that the schema of a level has") {
    const TemporaryFolder folder;
    const std::string listed = run_limn(folder, {"components", "--all"}).out;
    const Result<JsonValue> schema =
        parse_json(run_limn(folder, {"components", "--schema"}).out, "schema");
    REQUIRE(schema.ok());
    std::set<std::string> names;
    find_properties(*schema, names);
    CHECK(names.size() > 500);
    for (const char* const key : {"tiling", "pattern", "like", "vary", "srgb", "every"}) {
        CHECK(names.contains(key));
    }
    std::set<std::string> words;
    std::string word;
    for (const char c : listed) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$') {
            word += c;
        } else {
            words.insert(std::exchange(word, {}));
        }
    }
    for (const std::string& name : names) {
        CAPTURE(name);
        CHECK((words.contains(name) || name == "make"));  // "make" is in the headings
    }
    const std::string material = run_limn(folder, {"components", "material"}).out;
    CHECK(material.find("list  repetitions of all maps") != std::string::npos);
    CHECK(run_limn(folder, {"components", "event"}).out.find("    every ") != std::string::npos);
}

TEST_CASE("cli: info shows the hierarchy, skins, and what textures hold") {
    const TemporaryFolder folder;
    test::write_text(folder.file("my.level.json"), R"({
        "images": {"oak": {"make": "wood", "size": 16}},
        "materials": {"oak": {"pattern": "oak"}, "plain": {}},
        "meshes": {"fox": {"make": "creature"}},
        "entities": [{"name": "post", "children": [{"name": "arm", "children": [{"name": "lamp"}]}]},
                     {"name": "grass", "repeat": {"count": [50, 1, 1]}}]})");
    const ProgramRun run = run_limn(folder, {"info", "my.level.json"});
    CHECK(run.exit_code == 0);
    CAPTURE(run.out);
    CHECK(
        run.out.find("hierarchy\n    post\n      arm\n        lamp\n    grass[0]\n")
        != std::string::npos);
    CHECK(run.out.find("grass[36]\n    ... and 14 more\n1 mesh, ") != std::string::npos);
    CHECK(run.out.find("metalness mapped  roughness mapped  oak\n") != std::string::npos);
    CHECK(run.out.find("metalness 0.00    roughness 0.50    plain\n") != std::string::npos);
    CHECK(run.out.find("1 skin\n") != std::string::npos);
    CHECK(run.out.find(" joints  fox\n") != std::string::npos);
}

TEST_CASE("cli: info lists the capacity of particles, by emitter and in total") {
    const TemporaryFolder folder;
    test::write_text(folder.file("my.level.json"), R"({
        "entities": [{"name": "smoke", "particle_emitter": {"capacity": 1024}, "repeat": {"count": [3, 1, 1]}},
                     {"name": "spark", "particle_emitter": {"capacity": 512}},
                     {"name": "dust", "particle_emitter": {"capacity": 300000}},
                     {"name": "post"}]})");
    const ProgramRun run = run_limn(folder, {"info", "my.level.json"});
    CHECK(run.exit_code == 0);
    CAPTURE(run.out);
    // 36 bytes each; on the GPU 28 more, to draw it.
    CHECK(
        run.out.find("5 particle emitters\n"
                     "       3      3072 particles      108.0 KiB  cpu  smoke\n"
                     "       1       512 particles       18.0 KiB  cpu  spark\n"
                     "       1    300000 particles    18750.0 KiB  gpu  dust\n"
                     "       4      3584 particles      126.0 KiB  cpu, total\n"
                     "       1    300000 particles    18750.0 KiB  gpu, total\n")
        != std::string::npos);
    test::write_text(folder.file("none.level.json"), R"({"entities": [{"name": "post"}]})");
    CHECK(run_limn(folder, {"info", "none.level.json"}).out.find("emitter") == std::string::npos);
}

TEST_CASE("cli: info names every material's shading model") {
    const TemporaryFolder folder;
    test::write_text(
        folder.file("my.level.json"),
        R"({"materials": {"wax": {"shading": "subsurface"}, "plain": {"shading": "unlit"}}})");
    const ProgramRun run = run_limn(folder, {"info", "my.level.json"});
    CHECK(run.exit_code == 0);
    CHECK(
        run.out.find("\n    subsurface  metalness 0.00    roughness 0.50    wax\n")
        != std::string::npos);
    CHECK(run.out.find("    unlit") != std::string::npos);
}

TEST_CASE("cli: check draws a valid level, and warns of what has no effect") {
    const TemporaryFolder folder;
    const ProgramRun good = run_limn(folder, {"check", "lights"});
    CAPTURE(good.err);
    CHECK(good.exit_code == 0);
    CHECK(good.err.empty());
    CHECK(good.out.find("drew a frame; no warnings") != std::string::npos);
    test::write_text(folder.file("a.level.json"), R"({
      "$schema": "level.schema.json", "title": "Nothing has an effect",
      "meshes": {"hills": {"make": "terrain", "divisions": 4, "height": 7, "clearing": 17}},
      "entities": [
        {"name": "hills", "mesh_instance": {"mesh": "hills"}},
        {"name": "eye", "camera": {}},
        {"name": "other eye", "camera": {}},
        {"name": "lamp", "shadow": {}, "light_pulse": {}},
        {"name": "sea", "ocean": {}},
        {"name": "lens", "lens": {}, "autofocus": {}},
        {"name": "cart", "path_follower": {}}
      ]})");
    const ProgramRun bad = run_limn(folder, {"check", "a.level.json"});
    CHECK(bad.exit_code == 0);
    for (const char* says :
         {"entity \"lamp\": shadow has no effect without point_light or spot_light or "
          "directional_light",
          "entity \"lamp\": light_pulse has", "entity \"sea\": ocean has no effect without water",
          "entity \"lens\": lens has no effect without camera", "autofocus has no effect",
          "entity \"cart\": path_follower has no effect without a path", "2 active cameras",
          "note: the clearing of the terrain with seed 1 lies at y = "}) {
        CAPTURE(says);
        CHECK(bad.err.find(says) != std::string::npos);
    }
    CHECK(count_lines(bad.err) == 8);
    CHECK(bad.out.find("7 warnings") != std::string::npos);
    CHECK(run_limn(folder, {"check", "none.level.json"}).exit_code == 1);
}

TEST_CASE("cli: info lists the joints of a glTF file, which a level can refer to") {
    const TemporaryFolder folder;
    test::write_text(folder.file("arm.gltf"), R"({
      "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"name": "elbow.L"}],
      "accessors": [{"componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1],
                     "bufferView": 0},
                    {"componentType": 5126, "count": 2, "type": "VEC3"}],
      "bufferViews": [{"buffer": 0, "byteLength": 8}],
      "buffers": [{"byteLength": 8, "uri": "data:application/octet-stream;base64,AAAAAAAAgD8="}],
      "animations": [{"samplers": [{"input": 0, "output": 1}],
                      "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]})");
    const ProgramRun run = run_limn(folder, {"info", "arm.gltf"});
    CAPTURE(run.err);
    CAPTURE(run.out);
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("skeleton of 2 joints  arm\n    arm\n    elbow.L\n") != std::string::npos);
}

TEST_CASE("cli: the state hash is the same on one thread, on two, and again") {
    const TemporaryFolder folder;
    const Words words = {"hash", "stress-instances", "--frames", "4", "--threads"};
    Words one = words;
    one.emplace_back("1");
    Words two = words;
    two.emplace_back("2");
    const ProgramRun first = run_limn(folder, one);
    CHECK(first.exit_code == 0);
    CHECK(count_lines(first.out) == 4);
    CHECK(first.out.starts_with("0 "));
    CHECK(run_limn(folder, two).out == first.out);
    CHECK(run_limn(folder, one).out == first.out);
    // Four steps give four states.
    const std::string last = first.out.substr(first.out.rfind('\n', first.out.size() - 2) + 1);
    CHECK(last.substr(last.find(' ')) != first.out.substr(1, first.out.find('\n')));
}

TEST_CASE("cli: the state hash of particles is the same for any number of threads") {
    const TemporaryFolder folder;
    for (const char* const level : {"forge", "storm", "vale"}) {
        CAPTURE(level);
        std::string hashes;
        for (const char* const threads : {"1", "2", "3", "7"}) {
            const ProgramRun run =
                run_limn(folder, {"hash", level, "--frames", "30", "--threads", threads});
            CHECK(run.exit_code == 0);
            hashes = hashes.empty() ? run.out : hashes;
            CHECK(run.out == hashes);
        }
        CHECK(count_lines(hashes) == 30);
    }
}

}  // namespace limn::cli_test
