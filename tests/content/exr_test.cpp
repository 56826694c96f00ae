#include "content/load/files/atomic_file.h"
#include "content/load/files/exr_file.h"
#include "ecs/components/surface.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <Imath/half.h>
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

namespace limn::exr_test {

using limn::test::TemporaryFolder;

namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// 256 x 256 values: every bit pattern of a half but the NaNs, which become 0.
ExrImage make_all_halves() {
    ExrImage image{.width = 256, .height = 256};
    std::vector<float> values(65536);
    for (std::uint32_t i = 0; i < 65536; ++i) {
        half h;
        h.setBits(static_cast<std::uint16_t>(i));
        values[i] = h.isNan() ? 0.0f : static_cast<float>(h);
    }
    add_layer(image, "", "R", values, true);
    return image;
}

ExrImage make_picture() {
    ExrImage image{.width = 7, .height = 5, .metadata = {{"limn/time", "1.5"}, {"owner", "tests"}}};
    std::vector<float> color;
    std::vector<float> depth;
    std::vector<float> normal;
    for (int i = 0; i < 35; ++i) {
        color.insert(color.end(), {0.5f * float(i), 1.0f, 1024.0f, 0.25f});
        depth.push_back(std::ldexp(1.1f, i - 20));
        normal.insert(normal.end(), {0.1f * float(i), -1.0f, 0.3f});
    }
    add_layer(image, "", "RGBA", color, true);
    add_layer(image, "depth", "Z", depth, false);
    add_layer(image, "normal", "XYZ", normal, false);
    return image;
}

std::vector<std::byte>
bytes_of(const ExrImage& image, ExrCompression compression = ExrCompression::Zip) {
    const TemporaryFolder folder;
    REQUIRE(write_exr(folder.file("a.exr"), image, compression).ok());
    return read_file(folder.file("a.exr")).value();
}

/// Where the value of the header attribute `name` of `type` begins.
std::size_t find_attribute(
    const std::vector<std::byte>& bytes, const std::string& name, const std::string& type) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string key = name + '\0' + type + '\0';
    const std::size_t at = text.find(key);
    REQUIRE(at != std::string_view::npos);
    return at + key.size() + 4;
}

}  // namespace

TEST_CASE(
    "exr: halves are IEEE 754 binary16, rounded to even, in files and in textures"
    * technique("hdr.float-formats")) {
    const std::pair<float, std::uint16_t> cases[] = {
        {1.0f, 0x3C00},
        {-0.5f, 0xB800},
        {0.1f, 0x2E66},
        {1.0f / 3.0f, 0x3555},
        {0.18f, 0x31C3},
        {65504.0f, 0x7BFF},
        {65519.0f, 0x7BFF},
        {std::ldexp(1.0f, -14), 0x0400},
        {std::ldexp(1.0f, -24), 0x0001},
        {std::ldexp(1.0f, -26), 0x0000},
        {1 + std::ldexp(1.0f, -11), 0x3C00},  // ties
        {1 + std::ldexp(3.0f, -11), 0x3C02},
    };
    std::vector<float> values;
    for (const auto& tried : cases) {
        values.push_back(tried.first);
    }
    ExrImage image{.width = static_cast<int>(values.size()), .height = 1};
    add_layer(image, "", "Y", values, true);
    const Result<ExrImage> back = decode_exr(bytes_of(image), "a.exr");
    REQUIRE(back.ok());
    const ImageData texture = to_image_data(image, "exact");
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint16_t want = cases[i].second;
        half exact;
        exact.setBits(want);
        CAPTURE(values[i]);
        CHECK(back->channels[0].values[i] == static_cast<float>(exact));
        std::uint16_t bits = 0;
        std::memcpy(&bits, &texture.pixels[8 * i], 2);
        CHECK(bits == want);
    }
}

TEST_CASE(
    "exr: every half of a file reaches the texture without a change"
    * technique("hdr.float-formats")) {
    const ExrImage image = make_all_halves();
    const Result<ExrImage> back = decode_exr(bytes_of(image), "a.exr");
    REQUIRE(back.ok());
    const ImageData texture = to_image_data(*back, "all");
    REQUIRE(texture.format == PixelFormat::Rgba16F);
    REQUIRE(texture.pixels.size() == 65536 * 8);
    for (std::uint32_t i = 0; i < 65536; ++i) {
        const bool is_nan = (i & 0x7C00u) == 0x7C00u && (i & 0x03FFu) != 0;
        std::uint16_t bits[4];
        std::memcpy(bits, &texture.pixels[std::size_t{8} * i], 8);
        for (int c = 0; c < 3; ++c) {
            REQUIRE(bits[c] == (is_nan ? 0u : i));
        }
        REQUIRE(bits[3] == 0x3C00);
    }
}

TEST_CASE(
    "exr: a half image reads back bit for bit with every compression" * technique("hdr.openexr")) {
    const ExrImage image = make_all_halves();
    for (const ExrCompression compression :
         {ExrCompression::None, ExrCompression::Rle, ExrCompression::Zips, ExrCompression::Zip,
          ExrCompression::Piz}) {
        const std::vector<std::byte> bytes = bytes_of(image, compression);
        const unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
        CHECK(std::memcmp(bytes.data(), magic, 4) == 0);
        const Result<ExrImage> back = decode_exr(bytes, "a.exr");
        REQUIRE(back.ok());
        REQUIRE(back->channels.size() == 1);
        CHECK(back->channels[0].half);
        CHECK(
            std::memcmp(back->channels[0].values.data(), image.channels[0].values.data(), 65536 * 4)
            == 0);
    }
}

TEST_CASE("exr: layers, types, window and metadata survive") {
    ExrImage image = make_picture();
    image.x = -3;
    image.y = 12;
    const Result<ExrImage> back = decode_exr(bytes_of(image), "a.exr");
    REQUIRE(back.ok());
    CHECK(back->width == 7);
    CHECK(back->height == 5);
    CHECK(back->x == -3);
    CHECK(back->y == 12);
    REQUIRE(back->channels.size() == 8);
    for (const ExrChannel& channel : image.channels) {
        const ExrChannel* found = find_channel(*back, channel.name);
        REQUIRE(found != nullptr);
        CHECK(found->half == channel.half);
        CHECK(found->values == channel.values);
    }
    for (const auto& entry : image.metadata) {
        CHECK(
            std::find(back->metadata.begin(), back->metadata.end(), entry) != back->metadata.end());
    }
}

TEST_CASE("exr: half channels keep finite values finite, infinities infinite and NaN a NaN") {
    ExrImage image{.width = 4, .height = 1};
    const float infinity = std::numeric_limits<float>::infinity();
    add_layer(image, "", "R", std::vector<float>{1e9f, -1e9f, infinity, std::nanf("")}, true);
    const Result<ExrImage> back = decode_exr(bytes_of(image), "a.exr");
    REQUIRE(back.ok());
    const std::vector<float>& values = back->channels[0].values;
    CHECK(values[0] == 65504.0f);
    CHECK(values[1] == -65504.0f);
    CHECK(values[2] == infinity);
    CHECK(std::isnan(values[3]));
}

TEST_CASE("exr: non-finite values are replaced and counted") {
    std::vector<float> values = {1, std::nanf(""), INFINITY, -INFINITY, -2};
    CHECK(replace_non_finite(values) == 3);
    CHECK(values == std::vector<float>{1, 0, 65504, -65504, -2});
    CHECK(replace_non_finite(values) == 0);
}

TEST_CASE(
    "exr: as a texture a missing alpha is 1 and a lone channel is gray"
    * technique("hdr.openexr")) {
    ExrImage image{.width = 1, .height = 1};
    add_layer(image, "", "Y", std::vector<float>{0.5f}, true);
    const ImageData texture = to_image_data(image, "gray");
    CHECK(texture.format == PixelFormat::Rgba16F);
    REQUIRE(texture.pixels.size() == 8);
    std::uint16_t bits[4];
    std::memcpy(bits, texture.pixels.data(), 8);
    CHECK(bits[0] == 0x3800);
    CHECK(bits[2] == 0x3800);
    CHECK(bits[3] == 0x3C00);
}

TEST_CASE("exr: the display window is the image, black where the data window has no pixels") {
    // Pixel (x, y) of the data window has the value 10 x + y + 1.
    ExrImage image{.width = 3, .height = 2, .x = -1, .y = 4};
    std::vector<float> values;
    for (int y = 4; y < 6; ++y) {
        for (int x = -1; x < 2; ++x) {
            values.push_back(static_cast<float>(10 * x + y + 1));
        }
    }
    add_layer(image, "", "Y", values, false);
    const auto shown = [&](const ExrWindow& display) {
        image.display = display;
        const Result<ExrImage> back = decode_exr(bytes_of(image), "a.exr");
        REQUIRE(back.ok());
        CHECK(back->width == 3);
        const ImageData made = to_image_data(*back, "a");
        CHECK(made.width == display.width);
        CHECK(made.height == display.height);
        std::vector<float> gray;
        for (std::size_t i = 0; i < made.pixels.size(); i += 16) {
            float texel[4];
            std::memcpy(texel, &made.pixels[i], 16);
            CHECK(texel[1] == texel[0]);
            CHECK(texel[3] == 1);
            gray.push_back(texel[0]);
        }
        return gray;
    };
    CHECK(shown({-1, 4, 3, 2}) == values);
    CHECK(shown({0, 5, 1, 1}) == std::vector<float>{6});                   // overscan
    CHECK(shown({-2, 3, 3, 2}) == std::vector<float>{0, 0, 0, 0, -5, 5});  // a corner
    CHECK(shown({-1, 3, 4, 3}) == std::vector<float>{0, 0, 0, 0, -5, 5, 15, 0, -4, 6, 16, 0});
    CHECK(shown({100, 100, 2, 1}) == std::vector<float>{0, 0});
}

TEST_CASE("exr: a display window beyond the limits is refused, whatever the data window is") {
    ExrImage image{.width = 1, .height = 1};
    add_layer(image, "", "Y", std::vector<float>{1}, false);
    image.display = {0, 0, 20000, 10};
    const Result<ExrImage> wide = decode_exr(bytes_of(image), "a.exr");
    REQUIRE_FALSE(wide.ok());
    CHECK(contains(wide.error().message, "displayWindow: found 20000 x 10 pixels, expected 1 to"));
    image.display = {0, 0, 200, 100};
    CHECK_FALSE(decode_exr(bytes_of(image), "a.exr", {.max_values = 4 * 200 * 100 - 1}).ok());
    CHECK(decode_exr(bytes_of(image), "a.exr", {.max_values = 4 * 200 * 100}).ok());
}

TEST_CASE("exr: without R, G and B, the first layer with a color is shown and the others named") {
    const std::vector<float> color = {1, 2, 3};
    const auto with_layers = [&](const std::vector<std::string>& layers) {
        ExrImage image{.width = 1, .height = 1};
        for (const std::string& layer : layers) {
            const bool is_position = layer == "normal" || layer == "a.position";
            add_layer(image, layer, is_position ? "XYZ" : "RGB", color, false);
        }
        return image;
    };
    const ExrImage plain = with_layers({"", "a", "b"});
    CHECK(find_shown(plain).layer.empty());
    CHECK(describe_shown(plain).empty());
    const ExrImage layers = with_layers({"a.position", "glossy.x", "diffuse", "normal"});
    CHECK(find_shown(layers).layer == "glossy.x");
    CHECK(
        describe_shown(layers)
        == "found no channels R, G and B; of its layers, glossy.x is shown, and not a.position, "
           "diffuse, normal");
    const ImageData shown = to_image_data(layers, "a");
    float texel[4];
    std::memcpy(texel, shown.pixels.data(), 16);
    CHECK(texel[0] == 1);
    CHECK(texel[2] == 3);
    CHECK(texel[3] == 1);
    CHECK(find_shown(with_layers({"a.position", "normal"})).layer == "a.position");
    CHECK(describe_shown(with_layers({"normal"})).empty());
    ExrImage odd{.width = 1, .height = 1};
    add_layer(odd, "", "AQZ", color, false);
    CHECK(find_shown(odd).channels[0] == 1);
    CHECK(find_shown(odd).channels[3] == 0);
    CHECK(
        describe_shown(odd)
        == "found no channels R, G and B; of its layers, Q is shown, and not Z");
}

TEST_CASE("exr: the reports of windows have the pixels of their display windows") {
    for (const auto& [name, size] : {std::pair("crop", 16), {"over", 8}, {"plain", 8}}) {
        const std::string file = name;  // a binding cannot be captured
        const auto path = limn::test::shared_report("25-exr-windows/" + file + ".exr");
        if (!path) {
            return;
        }
        CAPTURE(file);
        const Result<ExrImage> exr = read_exr(*path);
        REQUIRE(exr.ok());
        const ImageData image = to_image_data(*exr, "a");
        CHECK(image.width == size);
        CHECK(image.height == size);
        if (file != "crop") {
            continue;
        }
        REQUIRE(image.format == PixelFormat::Rgba32F);
        for (int i = 0; i < 256; ++i) {
            const int x = i % 16;
            const int y = i / 16;
            float red = 0;
            std::memcpy(&red, &image.pixels[16 * static_cast<std::size_t>(i)], 4);
            CHECK(red == (x >= 4 && x < 12 && y >= 4 && y < 12 ? 0.5f : 0.0f));
        }
    }
}

TEST_CASE("exr: broken files are errors of one line" * technique("hdr.openexr")) {
    const std::vector<std::byte> good = bytes_of(make_picture());
    std::vector<std::byte> wrong_magic = good;
    wrong_magic[0] = std::byte{0x77};
    std::vector<std::byte> truncated = good;
    truncated.resize(good.size() * 2 / 3);
    std::vector<std::byte> negative = good;
    const std::int32_t minus_five = -5;
    std::memcpy(&negative[find_attribute(good, "dataWindow", "box2i") + 8], &minus_five, 4);
    std::vector<std::byte> absurd = good;
    const std::int32_t large = 2'000'000'000;
    std::memcpy(&absurd[find_attribute(good, "dataWindow", "box2i") + 12], &large, 4);
    std::vector<std::byte> wide = good;
    const std::int32_t wide_max = 40'000;
    std::memcpy(&wide[find_attribute(good, "dataWindow", "box2i") + 8], &wide_max, 4);
    std::vector<std::byte> deep = good;
    deep[5] |= std::byte{0x08};
    std::vector<std::byte> tiled = good;
    tiled[5] |= std::byte{0x02};

    const std::pair<const char*, std::vector<std::byte>> cases[] = {
        {"expected 76 2f 31 01", wrong_magic},
        {"", truncated},
        {"", negative},
        {"", absurd},
        {"40001 x 5", wide},
        {"deep OpenEXR file, which is unsupported", deep},
        {"tiled OpenEXR file, which is unsupported", tiled},
        {"0 bytes", {}},
    };
    for (const auto& tried : cases) {  // clang 14 captures no structured bindings
        const char* const expected = tried.first;
        const std::vector<std::byte>& bytes = tried.second;
        CAPTURE(expected);
        const Result<ExrImage> image = decode_exr(bytes, "a.exr");
        REQUIRE_FALSE(image.ok());
        const std::string& message = image.error().message;
        CAPTURE(message);
        CHECK(message.starts_with("a.exr: "));
        CHECK(contains(message, expected));
        CHECK_FALSE(contains(message, "\n"));
    }
    CHECK(contains(read_exr("/nonexistent/a.exr").error().message, "no such file"));
}

TEST_CASE("exr: a damaged byte never does more than fail") {
    const std::vector<std::byte> good = bytes_of(make_picture());
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
            std::vector<std::byte> bad = good;
            bad[i] ^= static_cast<std::byte>(flip);
            (void)decode_exr(bad, "bad", {.max_size = 256, .max_values = 1 << 20});
        }
    }
    for (std::size_t size = 0; size < good.size(); ++size) {
        CHECK_FALSE(decode_exr(std::span(good).first(size), "short").ok());
    }
}

}  // namespace limn::exr_test
