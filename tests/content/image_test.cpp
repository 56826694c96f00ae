#include "content/load/files/atomic_file.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/files/png_check.h"
#include "content/load/files/png_file.h"
#include "ecs/components/surface.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <sys/wait.h>
#include <unistd.h>

namespace limn::image_test {

using limn::test::TemporaryFolder;

namespace {

/// 3 x 2 RGBA pixels, all different, with alphas that multiplying into the color would spoil.
const std::vector<std::uint8_t> kPixels = {255, 0,  0,  255, 0,  255, 0,  128, 0,  0,  255, 1,
                                           10,  20, 30, 0,   40, 50,  60, 77,  70, 80, 90,  254};

std::vector<std::byte> png_bytes(int width, int height, int channels) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> pixels(
        static_cast<std::size_t>(width) * static_cast<std::size_t>(height)
        * static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<std::uint8_t>(i * 37);
    }
    REQUIRE(write_png(folder.file("a.png"), width, height, channels, pixels).ok());
    return read_file(folder.file("a.png")).value();
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Makes a valid header of a PNG claim another size.
void set_png_size(std::vector<std::byte>& png, std::uint32_t width, std::uint32_t height) {
    const auto put = [&png](std::size_t at, std::uint32_t value) {
        for (std::size_t i = 0; i < 4; ++i) {
            png[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
        }
    };
    put(16, width);
    put(20, height);
    put(29, crc32_of(std::span(png).subspan(12, 17)));
}

}  // namespace

TEST_CASE("image: a PNG reads back as it was written, colors untouched by alpha") {
    const TemporaryFolder folder;
    const std::string path = folder.file("small.png");
    REQUIRE(write_png(path, 3, 2, 4, kPixels).ok());
    const Result<ImageData> image = load_image(path, true);
    REQUIRE(image.ok());
    CHECK(image->name == "small");
    CHECK(image->width == 3);
    CHECK(image->height == 2);
    CHECK(image->srgb);
    CHECK(image->format == PixelFormat::Rgba8);
    CHECK(image->pixels == kPixels);
}

TEST_CASE("image: gray and RGB become RGBA with alpha 1, gray with alpha keeps it") {
    for (int channels = 1; channels <= 4; ++channels) {
        const std::vector<std::byte> bytes = png_bytes(5, 4, channels);
        const Result<ImageData> image = decode_image(bytes, "test", false);
        REQUIRE(image.ok());
        REQUIRE(image->pixels.size() == 5 * 4 * 4);
        for (int i = 0; i < 20; ++i) {
            const auto source = [&](int k) {
                return static_cast<std::uint8_t>((i * channels + k) * 37);
            };
            const bool gray = channels < 3;
            CHECK(image->pixels[4 * i] == source(0));
            CHECK(image->pixels[4 * i + 1] == source(gray ? 0 : 1));
            CHECK(image->pixels[4 * i + 2] == source(gray ? 0 : 2));
            CHECK(image->pixels[4 * i + 3] == (channels % 2 == 1 ? 255 : source(channels - 1)));
        }
    }
}

TEST_CASE("image: the same pixels give the same file") {
    CHECK(png_bytes(9, 7, 3) == png_bytes(9, 7, 3));
}

TEST_CASE("image: an EXR file reads as floats, whatever the file is called") {
    const TemporaryFolder folder;
    ExrImage exr{.width = 2, .height = 1};
    add_layer(exr, "", "RGB", std::vector<float>{0.1f, 2, 3, 1e5f, 5, 6}, false);
    REQUIRE(write_exr(folder.file("lies.png"), exr).ok());
    const Result<ImageData> image = load_image(folder.file("lies.png"), true);
    REQUIRE(image.ok());
    CHECK(image->format == PixelFormat::Rgba32F);
    CHECK_FALSE(image->srgb);
    float values[8];
    REQUIRE(image->pixels.size() == sizeof(values));
    std::memcpy(values, image->pixels.data(), sizeof(values));
    CHECK(values[0] == 0.1f);
    CHECK(values[3] == 1.0f);
    CHECK(values[4] == 1e5f);
}

TEST_CASE("image: every invalid file gives one line that names it") {
    const TemporaryFolder folder;
    std::vector<std::byte> huge = png_bytes(4, 4, 3);
    set_png_size(huge, 100'000, 2);
    std::vector<std::byte> truncated = png_bytes(64, 64, 3);
    truncated.resize(truncated.size() / 2);
    std::vector<std::byte> corrupt = png_bytes(64, 64, 3);
    for (std::size_t i = 60; i < corrupt.size(); i += 3) {
        corrupt[i] ^= std::byte{0x5a};
    }
    std::vector<std::byte> jpeg(200, std::byte{0x11});
    std::memcpy(jpeg.data(), "\xff\xd8\xff\xe0", 4);
    const std::string text = "this is no picture";
    const auto as_bytes = std::as_bytes(std::span(text));
    const std::pair<const char*, std::vector<std::byte>> cases[] = {
        {"100000 x 2 pixels", huge},
        {"truncated", truncated},
        {"wrong checksum", corrupt},
        {"truncated", jpeg},
        {"unknown format", {as_bytes.begin(), as_bytes.end()}},
        {"found an empty file", {}},
    };
    for (const auto& [expected, bytes] : cases) {
        const Result<ImageData> image = decode_image(bytes, "scene.gltf: images[3]", true);
        REQUIRE_FALSE(image.ok());
        const std::string& message = image.error().message;
        CAPTURE(message);
        CHECK(message.starts_with("scene.gltf: images[3]: "));
        CHECK(contains(message, expected));
        CHECK_FALSE(contains(message, "\n"));
    }
    CHECK(contains(load_image(folder.file("no.png"), true).error().message, "no such file"));
    CHECK(contains(load_image(folder.path(), true).error().message, "found a folder"));
}

TEST_CASE("image: an image of many pixels is refused before memory is taken for it") {
    std::vector<std::byte> png = png_bytes(4, 4, 3);
    set_png_size(png, 16'000, 16'000);
    const Result<ImageData> image = decode_image(png, "bomb", true, {.max_pixels = 1'000'000});
    REQUIRE_FALSE(image.ok());
    CHECK(contains(image.error().message, "16000 x 16000"));
}

TEST_CASE("image: every damaged byte and every missing end of a PNG is noticed") {
    const std::vector<std::byte> good = png_bytes(16, 16, 4);
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::vector<std::byte> bad = good;
        bad[i] ^= std::byte{0xff};
        CHECK_FALSE(decode_image(bad, "bad", true, {.max_size = 64}).ok());
        bad.resize(i);
        CHECK_FALSE(decode_image(bad, "short", true).ok());
    }
}

TEST_CASE("atomic_file: a file is replaced as a whole, and a failure changes nothing") {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.txt");
    REQUIRE(write_file(path, std::string("old")).ok());
    REQUIRE(write_file(path, std::string("new and longer")).ok());
    CHECK(read_file(path)->size() == 14);
    std::size_t entries = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        ++entries;
    }
    CHECK(entries == 1);  // nothing temporary stays

    const Status nowhere = write_file(folder.file("none/a.txt"), std::string("x"));
    REQUIRE_FALSE(nowhere.ok());
    CHECK(contains(nowhere.error().message, "does not exist"));
    CHECK_FALSE(write_file(folder.path(), std::string("x")).ok());
}

TEST_CASE("atomic_file: killing the writer at any moment leaves whole files only") {
    const TemporaryFolder folder;
    for (int round = 0; round < 20; ++round) {
        const pid_t child = fork();
        if (child == 0) {
            const std::string text(1 << 20, static_cast<char>('a' + round));
            for (int i = 0;; i = (i + 1) % 50) {
                (void)write_file(folder.file(std::to_string(i) + ".txt"), text);
            }
        }
        usleep(3000 + 1700 * round);
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
    }
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        if (entry.path().extension() == ".txt") {
            ++files;
            CHECK(entry.file_size() == 1 << 20);
        }
    }
    CHECK(files > 0);
}

}  // namespace limn::image_test
