#include "content/bake/block_encode.h"
#include "content/bake/block_image.h"
#include "ecs/base/gradient_noise.h"
#include "ecs/base/jobs.h"
#include "ecs/base/srgb.h"
#include "ecs/components/image_blocks.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

namespace limn::block_encode_test {
namespace {

/// Bits of a hand-made block, the lowest first.
struct HandMade {
    BlockBytes bytes = {};
    int at = 0;

    void put(int value, int count) {
        for (int i = 0; i < count; ++i, ++at) {
            bytes[static_cast<std::size_t>(at / 8)] |=
                static_cast<std::uint8_t>(((value >> i) & 1) << (at % 8));
        }
    }
};

ImageData image_of(int width, int height, const std::function<Vec4(int, int)>& texel) {
    ImageData image;
    image.name = "image";
    image.width = width;
    image.height = height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Vec4 value = glm::clamp(texel(x, y), Vec4(0), Vec4(1));
            for (int c = 0; c < 4; ++c) {
                image.pixels.push_back(static_cast<std::uint8_t>(255.0f * value[c] + 0.5f));
            }
        }
    }
    return image;
}

/// Four octaves of value noise, 0 .. 1.
float cloud(float x, float y, std::uint32_t seed) {
    float sum = 0;
    float amplitude = 0.5f;
    for (std::uint32_t octave = 0; octave < 5; ++octave) {
        const auto corner = [&](float u, float v) {
            std::uint32_t h = (static_cast<std::uint32_t>(static_cast<int>(u)) * 374761393u
                               + static_cast<std::uint32_t>(static_cast<int>(v)) * 668265263u)
                              ^ ((seed + octave) * 2246822519u);
            h = (h ^ (h >> 13)) * 1274126177u;
            return static_cast<float>((h ^ (h >> 16)) & 0xffff) / 65535.0f;
        };
        const float u = std::floor(x);
        const float v = std::floor(y);
        sum += amplitude
               * std::lerp(
                   std::lerp(corner(u, v), corner(u + 1, v), x - u),
                   std::lerp(corner(u, v + 1), corner(u + 1, v + 1), x - u), y - v);
        x *= 2;
        y *= 2;
        amplitude *= 0.5f;
    }
    return sum;
}

/// Leaves before a sky: soft and rough colors with hard edges between them.
ImageData natural(int width, int height, bool with_alpha) {
    return image_of(width, height, [with_alpha](int column, int row) {
        const auto x = static_cast<float>(column);
        const auto y = static_cast<float>(row);
        const bool leaf = cloud(x / 24, y / 24, 9) > 0.48f;
        const Vec3 color = leaf ? Vec3(0.3f, 0.55f, 0.15f) * (0.2f + 1.6f * cloud(x / 6, y / 6, 1))
                                : Vec3(0.5f, 0.7f, 1.0f) * (0.6f + 0.4f * cloud(x / 64, y / 64, 2));
        return Vec4(color, with_alpha ? cloud(x / 32, y / 32, 3) : 1.0f);
    });
}

ImageData bumps(int width, int height) {
    return image_of(width, height, [](int x, int y) {
        const auto at = [&](float dx, float dy) {
            return 6
                   * cloud((static_cast<float>(x) + dx) / 24, (static_cast<float>(y) + dy) / 24, 5);
        };
        const Vec3 n = glm::normalize(Vec3(at(-1, 0) - at(1, 0), at(0, -1) - at(0, 1), 2));
        return Vec4(0.5f * n + 0.5f, 1);
    });
}

double psnr(const ImageData& a, const ImageData& b, std::size_t first, std::size_t count) {
    REQUIRE(a.pixels.size() == b.pixels.size());
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const int d = i % 4 >= first && i % 4 < first + count ? a.pixels[i] - b.pixels[i] : 0;
        sum += static_cast<double>(d * d);
    }
    const double values = static_cast<double>(a.pixels.size() * count) / 4;
    return 10 * std::log10(255.0 * 255.0 * values / std::max(sum, 1e-9));
}

Vec3 normal_at(const ImageData& image, std::size_t texel) {
    const std::uint8_t* const rgb = &image.pixels[4 * texel];
    return glm::normalize(Vec3(rgb[0], rgb[1], rgb[2]) / 127.5f - 1.0f);
}

}  // namespace

TEST_CASE(
    "block encode: every mode of BC7 decodes hand-made endpoints at both ends of its weights"
    * technique("engine.opt-texture")) {
    for (int number = 0; number < 8; ++number) {
        CAPTURE(number);
        const Bc7Mode& mode = kBc7Modes[static_cast<std::size_t>(number)];
        const int partition = mode.partition_bits > 0 ? 13 : 0;
        HandMade block;
        block.put(1 << number, number + 1);
        block.put(partition, mode.partition_bits);
        block.put(0, mode.rotation_bits + mode.selection_bits);
        const auto code = [](int channel, int end) { return 3 + 2 * channel + end; };
        for (int c = 0; c < 4; ++c) {
            for (int e = 0; e < 2 * mode.subsets; ++e) {
                block.put(code(c, e), c < 3 ? mode.color_bits : mode.alpha_bits);
            }
        }
        const int pbits = mode.endpoint_pbits * 2 * mode.subsets + mode.subset_pbits * mode.subsets;
        block.put((1 << pbits) - 1, pbits);  // all 1
        const auto is_anchor = [&](int texel) {
            bool found = false;
            for (int s = 0; s < mode.subsets; ++s) {
                found = found || bc7_anchor(mode.subsets, partition, s) == texel;
            }
            return found;
        };
        for (int i = 0; i < 16; ++i) {  // anchors at the first endpoint, all others at the second
            block.put(is_anchor(i) ? 0 : 15, mode.index_bits - (is_anchor(i) ? 1 : 0));
        }
        for (int i = 0; i < 16 && mode.second_index_bits > 0; ++i) {
            block.put(i == 0 ? 0 : 15, mode.second_index_bits - (i == 0 ? 1 : 0));
        }
        CHECK(block.at == 128);
        const BlockTexels texels = decode_bc7(block.bytes);
        const int extra = mode.endpoint_pbits + mode.subset_pbits;
        for (int i = 0; i < 16; ++i) {
            const int end = 2 * bc7_subset(mode.subsets, partition, i) + (is_anchor(i) ? 0 : 1);
            for (int c = 0; c < 4; ++c) {
                const int bits = (c < 3 ? mode.color_bits : mode.alpha_bits) + extra;
                const int stored = extra > 0 ? 2 * code(c, end) + 1 : code(c, end);
                // replicated bits are the nearest to stored * 255 / (2^bits - 1), to 1
                const double nearest = 255.0 * stored / ((1 << bits) - 1);
                const int found = texels[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)];
                CHECK(
                    (c == 3 && mode.alpha_bits == 0 ? found == 255
                                                    : std::abs(found - nearest) <= 1));
            }
        }
    }
    CHECK(decode_bc7(BlockBytes{})[5] == std::array<std::uint8_t, 4>{0, 0, 0, 0});
}

TEST_CASE(
    "block encode: rotation and index selection of mode 4 swap channels and indices"
    * technique("engine.opt-texture")) {
    for (int rotation = 0; rotation < 4; ++rotation) {
        for (int selection = 0; selection < 2; ++selection) {
            HandMade block;
            block.put(16, 5);
            block.put(rotation, 2);
            block.put(selection, 1);
            for (const int code : {0, 31, 0, 0, 0, 31}) {  // red and blue 0 .. 255, green 0
                block.put(code, 5);
            }
            block.put(0, 6);
            block.put(63, 6);  // alpha 0 .. 255
            for (int i = 0; i < 16; ++i) {
                block.put(0, i == 0 ? 1 : 2);
            }
            for (int i = 0; i < 16; ++i) {
                block.put(i == 0 ? 0 : 7, i == 0 ? 2 : 3);
            }
            // The 3-bit indices are of alpha, or of the color if selected.
            const int color = selection == 1 ? 255 : 0;
            const int alpha = 255 - color;
            std::array<int, 4> expected = {color, 0, color, alpha};
            if (rotation > 0) {
                std::swap(expected[3], expected[static_cast<std::size_t>(rotation - 1)]);
            }
            for (std::size_t c = 0; c < 4; ++c) {
                CHECK(decode_bc7(block.bytes)[7][c] == expected[c]);
            }
        }
    }
}

TEST_CASE(
    "block encode: BC5 has 8 values between its ends, or 6 with 0 and 255"
    * technique("engine.opt-texture")) {
    HandMade block;
    for (const auto& [first, second] : {std::pair(210, 0), std::pair(50, 100)}) {
        block.put(first, 8);
        block.put(second, 8);
        for (int i = 0; i < 16; ++i) {
            block.put(i % 8, 3);
        }
    }
    const BlockTexels texels = decode_bc5(block.bytes);
    const int red[8] = {210, 0, 180, 150, 120, 90, 60, 30};
    const int green[8] = {50, 100, 60, 70, 80, 90, 0, 255};
    for (std::size_t i = 0; i < 16; ++i) {
        CHECK(texels[i][0] == red[i % 8]);
        CHECK(texels[i][1] == green[i % 8]);
        CHECK(texels[i][2] == 0);
        CHECK(texels[i][3] == 255);
    }
}

TEST_CASE(
    "block encode: BC7 of a natural image has a PSNR of 42 dB, its alpha of 41 dB"
    * technique("engine.opt-texture")) {
    for (const bool with_alpha : {false, true}) {
        const ImageData image = natural(128, 96, with_alpha);
        const ImageData decoded =
            decoded_level(encode_blocks(image, {.kind = TexelKind::Data, .levels = false}));
        const double color = psnr(image, decoded, 0, 3);
        const double alpha = psnr(image, decoded, 3, 1);
        MESSAGE("color ", color, " dB, alpha ", alpha, " dB");
        CHECK(color >= 42);
        CHECK(alpha >= (with_alpha ? 41.0 : 99.0));  // opaque stays so, exactly
    }
}

TEST_CASE(
    "block encode: blocks of one color are exact but for the last bit, edges of two are sharp"
    * technique("engine.opt-texture")) {
    std::mt19937 random(4);
    for (int i = 0; i < 200; ++i) {
        BlockColors colors;
        colors.fill(Vec4(random() % 256, random() % 256, random() % 256, 255));
        const BlockTexels texels = decode_bc7(encode_bc7(colors));
        for (int c = 0; c < 4; ++c) {
            CHECK(std::abs(texels[9][static_cast<std::size_t>(c)] - colors[9][c]) <= 1);
        }
    }
    BlockColors halves;
    for (int i = 0; i < 16; ++i) {
        halves[static_cast<std::size_t>(i)] =
            i % 4 < 2 ? Vec4(250, 20, 90, 255) : Vec4(10, 200, 40, 255);
    }
    const BlockTexels texels = decode_bc7(encode_bc7(halves));
    for (std::size_t i = 0; i < 16; ++i) {
        for (int c = 0; c < 4; ++c) {
            CHECK(std::abs(texels[i][static_cast<std::size_t>(c)] - halves[i][c]) <= 2);
        }
    }
}

TEST_CASE(
    "block encode: BC5 of normals turns them by half a degree at most, on average"
    * technique("engine.opt-texture, bump.normal-encoding")) {
    const ImageData image = bumps(128, 96);
    const ImageData blocks =
        encode_blocks(image, {.format = PixelFormat::Bc5, .kind = TexelKind::Normal});
    const ImageData decoded = decoded_level(blocks);
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels.size() / 4; ++i) {
        const Vec3 a = normal_at(image, i);
        const Vec3 b = normal_at(decoded, i);
        sum += static_cast<double>(degrees(std::acos(std::min(glm::dot(a, b), 1.0f))));
    }
    const double mean = sum * 4 / static_cast<double>(image.pixels.size());
    MESSAGE("mean angle ", mean, " degrees");
    CHECK(mean <= 0.5);
    CHECK(mean > 0.01);
    for (int level = 1; level < blocks.mip_levels; ++level) {
        const ImageData coarse = decoded_level(blocks, level);
        for (std::size_t i = 0; i < coarse.pixels.size(); i += 4) {
            const Vec3 n =
                Vec3(coarse.pixels[i], coarse.pixels[i + 1], coarse.pixels[i + 2]) / 127.5f - 1.0f;
            CHECK(std::abs(glm::length(n) - 1) < 0.02f);  // unit again
        }
    }
}

TEST_CASE(
    "block encode: levels are means of linear light, of any size, and a third more memory"
    * technique("engine.opt-texture")) {
    const ImageData stripes =
        image_of(8, 8, [](int x, int) { return Vec4(Vec3(static_cast<float>(x % 2)), 1); });
    const ImageData color = encode_blocks(stripes, {});
    CHECK(color.srgb);
    CHECK(color.mip_levels == 4);
    const int gray = static_cast<int>(255 * srgb_from_linear(0.5f) + 0.5f);
    CHECK(std::abs(decoded_level(color, 1).pixels[0] - gray) <= 1);
    const ImageData data = encode_blocks(stripes, {.kind = TexelKind::Data});
    CHECK_FALSE(data.srgb);
    CHECK(std::abs(decoded_level(data, 3).pixels[0] - 128) <= 1);

    // 5 x 3 -> 2 x 1: the first texel covers 2.5 x 3 of them
    const ImageData ramp =
        image_of(5, 3, [](int x, int) { return Vec4(Vec3(static_cast<float>(x) / 5), 1); });
    const ImageData odd = encode_blocks(ramp, {.kind = TexelKind::Data});
    CHECK(odd.mip_levels == 3);
    const ImageData second = decoded_level(odd, 1);
    CHECK(second.width == 2);
    CHECK(second.height == 1);
    CHECK(std::abs(second.pixels[0] - 51 * (0 + 1 + 0.5 * 2) / 2.5) <= 1.5);
    CHECK(std::abs(second.pixels[4] - 51 * (0.5 * 2 + 3 + 4) / 2.5) <= 1.5);

    ImageData large;
    large.width = large.height = 1024;
    large.mip_levels = max_mip_levels(1024, 1024);
    const std::size_t plain = image_bytes(large);
    CHECK(large.mip_levels == 11);
    CHECK(plain == 4 * 1398101u);
    large.format = PixelFormat::Bc7;
    CHECK(static_cast<double>(image_bytes(large)) / static_cast<double>(plain) < 0.2501);
}

TEST_CASE(
    "block encode: odd sizes and single texels keep every texel"
    * technique("engine.opt-texture")) {
    for (const IVec2& size : {IVec2(1, 1), IVec2(1, 9), IVec2(7, 2), IVec2(13, 6), IVec2(4, 5)}) {
        CAPTURE(size.x);
        CAPTURE(size.y);
        const ImageData image = natural(size.x, size.y, false);
        const ImageData blocks = encode_blocks(image, {.kind = TexelKind::Data});
        CHECK(blocks.mip_levels == max_mip_levels(size.x, size.y));
        CHECK(blocks.pixels.size() == image_bytes(blocks));
        CHECK(psnr(image, decoded_level(blocks), 0, 4) > 36);
        const ImageData last = decoded_level(blocks, blocks.mip_levels - 1);
        CHECK(last.pixels.size() == 4);
        int rows = 0;
        (void)encode_blocks(image, {}, [&](int done) { rows = done; });
        CHECK(rows == block_rows(size.x, size.y, true));
    }
}

TEST_CASE(
    "block encode: the same bits for any number of threads" * technique("engine.opt-texture")) {
    const ImageData image = natural(150, 70, true);
    const int threads = thread_count();
    std::vector<ImageData> found;
    for (const int count : {1, 3}) {
        set_thread_count(count);
        found.push_back(encode_blocks(image, {}));
    }
    set_thread_count(threads);
    CHECK(found[0].pixels == found[1].pixels);
}

}  // namespace limn::block_encode_test
