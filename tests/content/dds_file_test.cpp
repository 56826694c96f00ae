#include "content/bake/block_image.h"
#include "content/load/files/asset_cache.h"
#include "content/load/files/dds_file.h"
#include "content/load/files/texture_load.h"
#include "content/load/made_assets.h"
#include "ecs/components/image_blocks.h"
#include "tests/content/level_text.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <vector>

namespace limn::dds_file_test {
namespace {

ImageData ramp(int width, int height) {
    ImageData image;
    image.name = "ramp";
    image.width = width;
    image.height = height;
    image.srgb = true;
    for (int i = 0; i < width * height; ++i) {
        const auto value = static_cast<std::uint8_t>(i * 5);
        image.pixels.insert(
            image.pixels.end(), {value, 100, static_cast<std::uint8_t>(~value), 255});
    }
    return image;
}

ImageData blocks_of(PixelFormat format, TexelKind kind) {
    return encode_blocks(ramp(13, 6), {.format = format, .kind = kind});
}

/// A file of BC7 with four bytes changed.
std::vector<std::byte> changed(std::size_t at, std::uint32_t value) {
    std::vector<std::byte> bytes = encode_dds(blocks_of(PixelFormat::Bc7, TexelKind::Color));
    std::memcpy(&bytes[at], &value, sizeof value);
    return bytes;
}

std::string error_of(std::span<const std::byte> bytes, const ImageLimits& limits = {}) {
    const Result<ImageData> image = decode_dds(bytes, "x.dds", limits);
    return image ? "" : image.error().message;
}

bool holds(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos && text.find('\n') == std::string::npos
           && text.starts_with("x.dds: ");
}

}  // namespace

TEST_CASE("dds file: blocks are read as they were written" * technique("engine.opt-texture")) {
    for (const auto& [format, kind] :
         {std::pair(PixelFormat::Bc7, TexelKind::Color),
          std::pair(PixelFormat::Bc7, TexelKind::Data),
          std::pair(PixelFormat::Bc5, TexelKind::Normal)}) {
        const ImageData blocks = blocks_of(format, kind);
        std::vector<std::byte> bytes = encode_dds(blocks);
        CHECK(is_dds_file(bytes));
        CHECK(bytes.size() == 148 + image_bytes(blocks));
        bytes.push_back(std::byte{7});  // is ignored
        const Result<ImageData> read = decode_dds(bytes, "x.dds", {});
        REQUIRE_MESSAGE(read.ok(), (read ? "" : read.error().message));
        CHECK(read->width == 13);
        CHECK(read->height == 6);
        CHECK(read->mip_levels == 4);
        CHECK(read->format == format);
        CHECK(read->srgb == (kind == TexelKind::Color));
        CHECK(read->pixels == blocks.pixels);
    }
}

TEST_CASE(
    "dds file: an image is decoded where texels are needed, a texture is not"
    * technique("engine.opt-texture")) {
    const ImageData blocks = blocks_of(PixelFormat::Bc7, TexelKind::Color);
    const std::vector<std::byte> bytes = encode_dds(blocks);
    const Result<ImageData> image = decode_image(bytes, "x.dds", true);
    REQUIRE(image.ok());
    CHECK(image->format == PixelFormat::Rgba8);
    CHECK(image->mip_levels == 1);
    CHECK(image->srgb);
    CHECK(image->pixels == decoded_level(blocks).pixels);
    const Result<ImageData> texture = decode_texture(bytes, "x.dds", false);
    REQUIRE(texture.ok());
    CHECK(texture->format == PixelFormat::Bc7);
    CHECK_FALSE(texture->srgb);  // the use of a texture counts
    CHECK(texture->mip_levels == 4);
}

TEST_CASE("dds file: older files have BC5 as ATI2 or BC5U, without levels") {
    const ImageData blocks =
        encode_blocks(ramp(8, 8), {.format = PixelFormat::Bc5, .levels = false});
    for (const char* const code : {"ATI2", "BC5U"}) {
        std::vector<std::byte> bytes = encode_dds(blocks);
        std::memcpy(&bytes[84], code, 4);
        std::memset(&bytes[28], 0, 4);
        bytes.erase(bytes.begin() + 128, bytes.begin() + 148);
        const Result<ImageData> read = decode_dds(bytes, "x.dds", {});
        REQUIRE_MESSAGE(read.ok(), (read ? "" : read.error().message));
        CHECK(read->format == PixelFormat::Bc5);
        CHECK(read->mip_levels == 1);
        CHECK(read->pixels == blocks.pixels);
    }
}

TEST_CASE("dds file: each fault of a file is one line") {
    const std::vector<std::byte> good = changed(0, 0x20534444);
    CHECK(error_of(good).empty());
    const std::span<const std::byte> all = good;
    CHECK(holds(error_of(all.first(100)), "found 100 bytes, expected at least 128"));
    CHECK(holds(error_of(all.first(140)), "expected at least 148"));
    CHECK(holds(error_of(all.first(200)), "found 52 bytes of blocks, expected"));
    CHECK(holds(error_of(changed(0, 5)), "expected a DDS image"));
    CHECK(holds(error_of(changed(4, 123)), "found headers of 123 and 32 bytes"));
    CHECK(holds(error_of(changed(12, 0)), "found 13 x 0 pixels"));
    CHECK(holds(error_of(changed(16, 0xffffffff)), "found 4294967295 x 6 pixels"));
    CHECK(holds(error_of(good, {.max_size = 12}), "found 13 x 6 pixels, expected at most 12"));
    CHECK(holds(error_of(changed(16, 16384)), "bytes of blocks, expected"));
    CHECK(
        holds(error_of(changed(28, 5)), "found 5 mip levels of 13 x 6 pixels, expected at most 4"));
    CHECK(holds(error_of(changed(80, 0x41)), "without blocks, expected BC5 or BC7"));
    CHECK(
        holds(error_of(changed(84, 0x31545844)), "found the DDS format DXT1, expected BC5 or BC7"));
    CHECK(holds(error_of(changed(84, 36)), "found the DDS format 0x24"));
    CHECK(holds(error_of(changed(112, 0x200)), "cube or volume"));
    CHECK(
        holds(error_of(changed(128, 71)), "found the DXGI format 71, expected 83 (BC5), 98 or 99"));
    CHECK(holds(error_of(changed(132, 4)), "volume, cube or array"));
    CHECK(holds(error_of(changed(140, 2)), "volume, cube or array"));
}

TEST_CASE(
    "dds file: a level compresses images, normals of materials as BC5"
    * technique("engine.opt-texture")) {
    constexpr const char* kLevel = R"({
        "images": {"wall": {"make": "bricks", "size": 32, "compress": true},
                   "plain": {"make": "bricks", "size": 32},
                   "folds": {"make": "bricks", "size": 16, "compress": true}},
        "materials": {"wall": {"pattern": "wall"},
                      "skin": {"wrinkle_texture": {"image": "folds.normal"}}}})";
    World world;
    const std::vector<std::string> messages =
        test::messages_of([&] { test::spawn_into(world, kLevel); });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("folds.normal is not compressed") != std::string::npos);
    const auto find = [&](const std::string& name) {
        for (const ImageData& image : world.resource<Assets>().images) {
            if (image.name == name) {
                return image;
            }
        }
        FAIL("no image ", name);
        return ImageData{};
    };
    const ImageData color = find("wall.base_color");
    CHECK(color.format == PixelFormat::Bc7);
    CHECK(color.srgb);
    CHECK(color.mip_levels == 6);
    CHECK(find("wall.normal").format == PixelFormat::Bc5);
    CHECK(find("wall.orm").format == PixelFormat::Bc7);
    CHECK_FALSE(find("wall.orm").srgb);
    CHECK(find("plain.base_color").format == PixelFormat::Rgba8);
    CHECK(find("folds.base_color").format == PixelFormat::Bc7);
    CHECK(find("folds.normal").format == PixelFormat::Rgba8);

    register_all_components();
    const Result<Level> bad = parse_level(
        R"({"images": {"wall": {"make": "bricks", "compress": "bc7"}}})", "t.level.json");
    REQUIRE_FALSE(bad.ok());
    CHECK(bad.error().message.find("expected true or false") != std::string::npos);
}

TEST_CASE("dds file: blocks are encoded once and found in the cache with another name") {
    const test::TemporaryFolder folder;
    ImageData image = ramp(256, 192);
    const ImageData first = MadeAssets{AssetCache(folder.path())}.blocks(image, {});
    image.name = "other";
    MadeAssets made{AssetCache(folder.path())};
    const ImageData second = made.blocks(image, {});
    CHECK(second.name == "other");
    CHECK(second.pixels == first.pixels);
    CHECK(second.mip_levels == first.mip_levels);
    CHECK(made.blocks(image, {.kind = TexelKind::Data}).srgb == false);
    CHECK(made.size() == 2);
    image.pixels[0] ^= 255;
    CHECK(made.blocks(image, {}).pixels != first.pixels);
}

}  // namespace limn::dds_file_test
