#include "content/load/level/level_load.h"
#include "ecs/components/all.h"
#include "ecs/components/name.h"
#include "ecs/world.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <fstream>
#include <string>

namespace limn::level_include_test {
namespace {

struct Files {
    test::TemporaryFolder folder;

    std::string write(const std::string& name, const std::string& text) const {
        const std::string path = folder.path() + "/" + name;
        std::ofstream(path) << text;
        return path;
    }
    std::string error(const std::string& level, const std::string& library) const {
        register_all_components();
        (void)write("a.effect.json", library);
        const Result<Level> loaded = load_level(write("t.level.json", level));
        return loaded ? "" : loaded.error().message.substr(folder.path().size() + 1);
    }
};

}  // namespace

TEST_CASE("include: prefabs with their materials and meshes; the level's own replace them") {
    register_all_components();
    const Files files;
    (void)files.write(
        "a.effect.json",
        R"({"title": "A", "materials": {"m": {"roughness": 0.1}, "n": {"roughness": 0.2}},
            "meshes": {"b": {"make": "box"}},
            "prefabs": {"lamp": {"mesh_instance": {"mesh": "b", "material": "n"}}}})");
    (void)files.write("b.effect.json", R"({"materials": {"n": {"roughness": 0.9}}})");
    Result<Level> level =
        load_level(files.write("t.level.json", R"({"include": ["a.effect.json", "b.effect.json"],
            "materials": {"m": {"roughness": 0.5}}, "entities": [{"name": "a lamp", "prefab": "lamp"}]})"));
    REQUIRE_MESSAGE(level.ok(), (level ? "" : level.error().message));
    REQUIRE(level->assets.materials.size() == 2);
    CHECK(level->assets.materials[0].roughness == 0.9f);  // the later file's
    CHECK(level->assets.materials[1].roughness == 0.5f);
    World world;
    (void)spawn_level(world, *std::move(level));
    CHECK(world.query<const Name>().count() == 1);
}

TEST_CASE("include: errors name the file in which they are, and files that exist") {
    const Files files;
    const std::string level = R"({"include": ["a.effect.json"], "entities": [{"prefab": "x"}]})";
    CHECK(files.error(level, "{\"prefabs\":\n {\"x\": {\"spinn\": {}}}}")
              .starts_with("a.effect.json:2:9: "));
    CHECK(files.error(level, "{\"entities\": []}").starts_with("a.effect.json:1:2: "));
    CHECK(files.error(level, "{\"include\": []}").starts_with("a.effect.json:1:2: "));
    CHECK(files.error(level, "{\"prefabs\":").starts_with("a.effect.json:1:"));
    CHECK(files.error(level, "[]").starts_with("a.effect.json"));
    const std::string missing = files.error(R"({"include": ["b.effect.json"]})", "{}");
    CHECK(missing.starts_with("t.level.json:1:14: include: "));
    CHECK(missing.find("a.effect.json") != std::string::npos);
    CHECK(missing.find("fireworks.effect.json") != std::string::npos);
    CHECK(files.error(R"({"include": [3]})", "{}").starts_with("t.level.json:1:14: "));
    CHECK(files.error(R"({"include": "a"})", "{}").starts_with("t.level.json:1:13: "));
    CHECK(files.error(R"({"include": ["/dev/zero"]})", "{}").starts_with("t.level.json:1:14: "));
}

}  // namespace limn::level_include_test
