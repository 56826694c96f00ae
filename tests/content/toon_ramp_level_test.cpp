#include "content/load/level/level_load.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <fstream>
#include <string>

namespace limn::toon_ramp_level_test {
namespace {

Result<Level> load(const std::string& material) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("t.level.json"))
        << R"({"title": "t", "materials": {"a": {"shading": "toon", )" + material
               + R"(}, "b": {"like": "a"}}})";
    return load_level(folder.file("t.level.json"));
}

}  // namespace

TEST_CASE(
    "toon ramp: a material has the colors that its level says, at most sixteen"
    * technique("tex.toon-ramp")) {
    const Result<Level> level = load(R"("ramp": [[0.1, 0.2, 0.3], [1, 1, 1]])");
    REQUIRE_MESSAGE(level.ok(), (level ? "" : level.error().message));
    for (const Material& material : level->assets.materials) {
        REQUIRE(material.ramp.size() == 2);
        CHECK(material.ramp[0] == Vec3(0.1f, 0.2f, 0.3f));
    }
    std::string colors;
    for (int i = 0; i < 17; ++i) {
        colors += i == 0 ? "[0, 0, 0]" : ", [0, 0, 0]";
    }
    const Result<Level> many = load("\"ramp\": [" + colors + "]");
    REQUIRE_FALSE(many.ok());
    CHECK(many.error().message.find("17 colors, expected at most 16") != std::string::npos);
}

}  // namespace limn::toon_ramp_level_test
