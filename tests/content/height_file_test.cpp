#include "content/load/files/exr_file.h"
#include "content/load/files/height_file.h"
#include "content/load/files/png_file.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace limn::height_file_test {

using test::TemporaryFolder;

TEST_CASE("height file: a PNG keeps all of its 16 bits, and 8 bits are 1/255 each") {
    const TemporaryFolder folder;
    const std::vector<std::uint16_t> words = {0, 1, 257, 32768, 65534, 65535};
    REQUIRE(write_png16(folder.file("a.png"), 3, 2, 1, words).ok());
    const auto deep = load_heights(folder.file("a.png"));
    REQUIRE(deep.ok());
    CHECK(deep->width == 3);
    CHECK(deep->height == 2);
    for (std::size_t i = 0; i < words.size(); ++i) {
        CHECK(deep->heights[i] == static_cast<float>(words[i]) / 65535);
    }
    const std::vector<std::uint8_t> bytes = {0, 9, 9, 51, 9, 9, 255, 9, 9};
    REQUIRE(write_png(folder.file("b.png"), 3, 1, 3, bytes).ok());
    const auto red = load_heights(folder.file("b.png"));
    REQUIRE(red.ok());
    CHECK(red->heights == std::vector<float>{0, 0.2f, 1});
}

TEST_CASE("height file: floats are not clamped, and NaN and infinity become 0") {
    const TemporaryFolder folder;
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> values = {-3, 0.5f, 100, NAN, infinity, 0.1f};
    for (const bool half : {false, true}) {
        ExrImage image = {.width = 2, .height = 3};
        add_layer(image, "", "Y", values, half);
        REQUIRE(write_exr(folder.file("a.exr"), image).ok());
        const auto heights = load_heights(folder.file("a.exr"));
        REQUIRE(heights.ok());
        CHECK(heights->width == 2);
        CHECK(heights->heights[0] == -3);
        CHECK(heights->heights[2] == 100);
        CHECK(heights->heights[3] == 0);
        CHECK(std::isfinite(heights->heights[4]));
        CHECK(std::abs(heights->heights[5] - 0.1f) < 1e-4f);
    }
}

TEST_CASE("height file: a missing, corrupt or too large file is an error with its name") {
    const TemporaryFolder folder;
    const auto message = [&](const std::string& name, const ImageLimits& limits = {}) {
        const auto heights = load_heights(folder.file(name), limits);
        return heights ? std::string("it loads") : heights.error().message;
    };
    CHECK(message("none.png").find("none.png") != std::string::npos);
    std::ofstream(folder.file("text.png")) << "not an image";
    CHECK(message("text.png").find("text.png: found 12 bytes") != std::string::npos);
    REQUIRE(write_png(folder.file("a.png"), 2, 1, 1, std::vector<std::uint8_t>{0, 1}).ok());
    CHECK(message("a.png", {.max_size = 1}).find("found 2 x 1 pixels") != std::string::npos);
    CHECK(message("a.png") == "it loads");
}

TEST_CASE("height file: images are recognized by their extension, in any case") {
    CHECK(is_image_name("a/b.PNG"));
    CHECK(is_image_name("heights.exr"));
    CHECK_FALSE(is_image_name("model.glb"));
    CHECK_FALSE(is_image_name("png"));
}

}  // namespace limn::height_file_test
