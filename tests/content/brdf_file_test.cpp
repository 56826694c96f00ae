#include "content/load/files/brdf_file.h"
#include "content/load/level/level_load.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <fstream>
#include <string>

namespace limn::brdf_file_test {
namespace {

const std::string kSet = "# synthetic\n"
                         "channel 0.60\nlobe -0.95 0.95 20\nlobe -0.55 0.45 4\n\n"
                         "channel 0.42 # green\n  lobe -0.9 0.8 10\r\n"
                         "channel 0.33\n";

std::string error_of(const std::string& text) {
    const Result<BrdfFit> fit = parse_brdf(text, "x.brdf");
    return fit ? "" : fit.error().message;
}

}  // namespace

TEST_CASE(
    "brdf file: each channel has its own lobes, padded with zero lobes"
    * technique("skin.brdf-lafortune")) {
    const Result<BrdfFit> fit = parse_brdf(kSet, "x.brdf");
    REQUIRE(fit.ok());
    CHECK(fit->diffuse == Vec3(0.60f, 0.42f, 0.33f));
    REQUIRE(fit->lobes.size() == 2);
    CHECK(fit->lobes[0].across == Vec3(-0.95f, -0.9f, 0));
    CHECK(fit->lobes[0].along == Vec3(0.95f, 0.8f, 0));
    CHECK(fit->lobes[0].exponent == Vec3(20, 10, 1));
    CHECK(fit->lobes[1].exponent == Vec3(4, 1, 1));
}

TEST_CASE("brdf file: bad lines are refused with their number") {
    CHECK(error_of("") == "x.brdf: found 0 channels, expected red, green and blue");
    CHECK(error_of("channel 1\n") == "x.brdf: found 1 channels, expected red, green and blue");
    CHECK(
        error_of("lobe 1 1 1\n")
        == "x.brdf:1: found \"lobe 1 1 1\", expected \"channel\" before its lobes");
    CHECK(
        error_of("\nhue 1\n")
        == "x.brdf:2: found \"hue 1\", expected a line that begins with \"channel\" or \"lobe\"");
    for (const char* bad :
         {"channel", "channel 2", "channel nan", "channel 0.5 3", "channel x", "channel -0.1"}) {
        CHECK(error_of(bad).find("expected \"channel\" and a number, 0 to 1") != std::string::npos);
    }
    for (const char* bad :
         {"lobe 1 1", "lobe 1 1 1 1", "lobe 3 1 1", "lobe 1 inf 1", "lobe 1 1 -1"}) {
        CHECK(
            error_of("channel 1\n" + std::string(bad)).find("x.brdf:2: found ")
            != std::string::npos);
    }
    CHECK(
        error_of("channel 1\nlobe 1 1 1\nlobe 1 1 1\nlobe 1 1 1\nlobe 1 1 1\nlobe 1 1 1\n")
        == "x.brdf:6: found \"lobe 1 1 1\", expected at most 4 lobes a channel");
    CHECK(
        error_of("channel 1\nchannel 1\nchannel 1\nchannel 1\n")
            .find("expected the end of the file")
        != std::string::npos);
}

TEST_CASE("brdf file: a material has what its file says, and so has one that starts from it") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("fair.brdf")) << kSet;
    const auto load = [&folder](const std::string& materials) {
        std::ofstream(folder.file("t.level.json"))
            << R"({"title": "t", "materials": {)" + materials + "}}";
        return load_level(folder.file("t.level.json"));
    };
    const Result<Level> level =
        load(R"("fair": {"brdf": "fair.brdf"}, "worn": {"like": "fair", "normal_scale": 2})");
    REQUIRE_MESSAGE(level.ok(), (level ? "" : level.error().message));
    for (const Material& material : level->assets.materials) {
        CHECK(material.shading == ShadingModel::Lafortune);
        CHECK(material.base_color == Vec4(0.60f, 0.42f, 0.33f, 1));
        CHECK(material.lobes.size() == 2);
    }
    CHECK(
        load(R"("fair": {"brdf": "dark.brdf"})").error().message.find("dark.brdf")
        != std::string::npos);
    CHECK(
        load(R"("fair": {"brdf": 3})").error().message.find("expected the path of a file")
        != std::string::npos);
    CHECK(
        load(R"("fair": {"lobes": [{}, {}, {}, {}, {}]})")
            .error()
            .message.find("5 lobes, expected at most 4")
        != std::string::npos);
}

}  // namespace limn::brdf_file_test
