#include "ecs/components/image_blocks.h"

#include "ecs/base/block_texture.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace limn {
namespace {

int level_side(int side, int level) {
    return std::max(side >> level, 1);
}

std::size_t blocks_along(int side) {
    return static_cast<std::size_t>(side + kBlockSide - 1) / kBlockSide;
}

void restore_z(BlockTexels& texels) {
    for (auto& texel : texels) {
        const float x = static_cast<float>(texel[0]) / 127.5f - 1.0f;
        const float y = static_cast<float>(texel[1]) / 127.5f - 1.0f;
        const float z = std::sqrt(std::max(1.0f - x * x - y * y, 0.0f));
        texel[2] = static_cast<std::uint8_t>(127.5f * (z + 1.0f) + 0.5f);
    }
}

}  // namespace

const char* format_name(PixelFormat format) {
    switch (format) {
    case PixelFormat::Rgba8:
        return "RGBA8";
    case PixelFormat::Rgba16F:
        return "RGBA16F";
    case PixelFormat::Rgba32F:
        return "RGBA32F";
    case PixelFormat::Bc5:
        return "BC5";
    case PixelFormat::Bc7:
        return "BC7";
    }
    return "?";
}

int max_mip_levels(int width, int height) {
    int levels = 1;
    while (std::max(width, height) >> levels > 0) {
        ++levels;
    }
    return levels;
}

std::size_t level_bytes(const ImageData& image, int level) {
    const int width = level_side(image.width, level);
    const int height = level_side(image.height, level);
    if (is_in_blocks(image.format)) {
        return blocks_along(width) * blocks_along(height) * kBlockBytes;
    }
    const std::size_t texel = image.format == PixelFormat::Rgba8     ? 4
                              : image.format == PixelFormat::Rgba16F ? 8
                                                                     : 16;
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * texel;
}

std::size_t image_bytes(const ImageData& image) {
    std::size_t bytes = 0;
    for (int level = 0; level < image.mip_levels; ++level) {
        bytes += level_bytes(image, level);
    }
    return bytes;
}

std::span<const std::uint8_t> level_pixels(const ImageData& image, int level) {
    std::size_t begin = 0;
    for (int finer = 0; finer < level; ++finer) {
        begin += level_bytes(image, finer);
    }
    LIMN_CHECK(level < image.mip_levels);
    LIMN_CHECK(begin + level_bytes(image, level) <= image.pixels.size());
    return std::span(image.pixels).subspan(begin, level_bytes(image, level));
}

ImageData decoded_level(const ImageData& image, int level) {
    LIMN_CHECK(is_in_blocks(image.format));
    ImageData decoded;
    decoded.name = image.name;
    decoded.width = level_side(image.width, level);
    decoded.height = level_side(image.height, level);
    decoded.srgb = image.srgb;
    decoded.pixels.resize(level_bytes(decoded, 0));
    const std::span<const std::uint8_t> blocks = level_pixels(image, level);
    const std::size_t columns = blocks_along(decoded.width);
    const auto width = static_cast<std::size_t>(decoded.width);
    parallel_for(blocks_along(decoded.height), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin * columns; b < end * columns; ++b) {
            const auto block = blocks.subspan(b * kBlockBytes).first<kBlockBytes>();
            BlockTexels texels =
                image.format == PixelFormat::Bc7 ? decode_bc7(block) : decode_bc5(block);
            if (image.format == PixelFormat::Bc5) {
                restore_z(texels);
            }
            const std::size_t x = b % columns * kBlockSide;
            const std::size_t rows = std::min<std::size_t>(
                kBlockSide, static_cast<std::size_t>(decoded.height) - b / columns * kBlockSide);
            for (std::size_t row = 0; row < rows; ++row) {
                const std::size_t y = b / columns * kBlockSide + row;
                std::memcpy(
                    &decoded.pixels[4 * (y * width + x)], &texels[row * kBlockSide],
                    4 * std::min<std::size_t>(kBlockSide, width - x));
            }
        }
    });
    return decoded;
}

}  // namespace limn
