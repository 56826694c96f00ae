// Files that Limn writes and reads, against OpenImageIO in its own right.

#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/files/png_file.h"
#include "ecs/components/surface.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::image_interchange_test {

using limn::test::TemporaryFolder;

namespace {

/// Writes an image with the format of the file's name.
template <typename T>
void write_with_oiio(
    const std::string& path, int width, int height, int channels, const std::vector<T>& values) {
    const auto output = OIIO::ImageOutput::create(path);
    REQUIRE(output != nullptr);
    OIIO::ImageSpec spec(width, height, channels, OIIO::BaseTypeFromC<T>::value);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    REQUIRE(output->open(path, spec));
    REQUIRE(output->write_image(spec.format, values.data()));
    REQUIRE(output->close());
}

}  // namespace

TEST_CASE("exr: OpenImageIO sees the same channels and values" * technique("hdr.openexr")) {
    const TemporaryFolder folder;
    ExrImage image{.width = 7, .height = 5};
    std::vector<float> color;
    std::vector<float> depth;
    for (int i = 0; i < 35; ++i) {
        color.insert(color.end(), {0.5f * static_cast<float>(i), 1.0f, 1024.0f, 0.25f});
        depth.push_back(std::ldexp(1.1f, i - 20));
    }
    add_layer(image, "", "RGBA", color, true);
    add_layer(image, "depth", "Z", depth, false);
    REQUIRE(write_exr(folder.file("a.exr"), image).ok());
    const auto input = OIIO::ImageInput::open(folder.file("a.exr"));
    REQUIRE(input != nullptr);
    const OIIO::ImageSpec& spec = input->spec();
    CHECK(spec.width == 7);
    CHECK(spec.height == 5);
    REQUIRE(spec.nchannels == 5);
    CHECK(std::string(spec.get_string_attribute("compression")) == "zip");
    std::vector<float> values(7 * 5 * 5);
    REQUIRE(input->read_image(0, 0, 0, 5, OIIO::TypeFloat, values.data()));
    for (int c = 0; c < 5; ++c) {
        const ExrChannel* channel =
            find_channel(image, spec.channelnames[static_cast<std::size_t>(c)]);
        REQUIRE(channel != nullptr);
        for (int i = 0; i < 35; ++i) {
            CHECK(values[5 * i + c] == channel->values[static_cast<std::size_t>(i)]);
        }
    }
}

TEST_CASE("image: a PNG with 16 bits keeps them") {
    const TemporaryFolder folder;
    std::vector<std::uint16_t> ramp(256 * 3);
    for (std::size_t i = 0; i < ramp.size(); ++i) {
        ramp[i] = static_cast<std::uint16_t>(i * 85);
    }
    REQUIRE(write_png16(folder.file("ramp.png"), 256, 1, 3, ramp).ok());
    const auto input = OIIO::ImageInput::open(folder.file("ramp.png"));
    REQUIRE(input != nullptr);
    CHECK(input->spec().format == OIIO::TypeUInt16);
    std::vector<std::uint16_t> found(ramp.size());
    REQUIRE(input->read_image(0, 0, 0, 3, OIIO::TypeUInt16, found.data()));
    CHECK(found == ramp);
}

TEST_CASE("image: PNG files of every kind and the other formats read as OpenImageIO wrote them") {
    const TemporaryFolder folder;
    for (int channels = 1; channels <= 4; ++channels) {
        std::vector<std::uint16_t> wide;
        for (int i = 0; i < 6 * channels; ++i) {
            wide.push_back(static_cast<std::uint16_t>(257 * (9 * i + 3)));
        }
        write_with_oiio(folder.file("wide.png"), 3, 2, channels, wide);
        const Result<ImageData> image = load_image(folder.file("wide.png"), true);
        REQUIRE(image.ok());
        CHECK(image->srgb);
        REQUIRE(image->pixels.size() == 24);
        for (std::size_t i = 0; i < 6; ++i) {
            const std::size_t first = i * static_cast<std::size_t>(channels);
            CHECK(image->pixels[4 * i] == wide[first] / 257);
            CHECK(image->pixels[4 * i + 1] == wide[first + (channels > 2 ? 1 : 0)] / 257);
            const bool alpha = channels % 2 == 0;
            const int last = wide[first + static_cast<std::size_t>(channels) - 1] / 257;
            CHECK(image->pixels[4 * i + 3] == (alpha ? last : 255));
        }
    }
    const std::vector<std::uint8_t> gray(16 * 16 * 3, 100);
    for (const char* name : {"flat.bmp", "flat.jpg", "flat.webp"}) {
        CAPTURE(name);
        write_with_oiio(folder.file(name), 16, 16, 3, gray);
        const Result<ImageData> image = load_image(folder.file(name), true);
        REQUIRE_MESSAGE(image.ok(), (image ? std::string() : image.error().message));
        CHECK(image->width == 16);
        CHECK(image->srgb);
        REQUIRE(image->pixels.size() == 16 * 16 * 4);
        CHECK(std::abs(image->pixels[500] - 100) <= 1);
        CHECK(image->pixels[503] == 255);
    }
    write_with_oiio(folder.file("light.hdr"), 2, 1, 3, std::vector<float>{0.5f, 8, 64, 1, 1, 1});
    const Result<ImageData> light = load_image(folder.file("light.hdr"), true);
    REQUIRE(light.ok());
    CHECK(light->format == PixelFormat::Rgba32F);
    CHECK_FALSE(light->srgb);
}

}  // namespace limn::image_interchange_test
