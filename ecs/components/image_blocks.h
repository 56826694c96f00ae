#pragma once

#include "ecs/components/surface.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

// Images in blocks of 4 x 4 texels (BC5, BC7), with their mip levels: sizes, and their texels on
// the CPU.

[[nodiscard]] constexpr bool is_in_blocks(PixelFormat format) {
    return format == PixelFormat::Bc5 || format == PixelFormat::Bc7;
}

/// "RGBA8", "BC7" ...
[[nodiscard]] const char* format_name(PixelFormat format);

/// Levels down to 1 x 1.
[[nodiscard]] int max_mip_levels(int width, int height);

/// Bytes of a level, 0 = the whole image.
[[nodiscard]] std::size_t level_bytes(const ImageData& image, int level);
/// Bytes of all levels that the image says that it has.
[[nodiscard]] std::size_t image_bytes(const ImageData& image);
/// The pixels of a level of a complete image.
[[nodiscard]] std::span<const std::uint8_t> level_pixels(const ImageData& image, int level);

/// A level of a complete image in blocks as RGBA8. Blue of BC5 is z = sqrt(1 - x^2 - y^2) of the
/// normal whose x and y are red and green, coded as those are.
[[nodiscard]] ImageData decoded_level(const ImageData& image, int level = 0);

}  // namespace limn
