#pragma once

#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// PNG files, encoded in memory by OpenImageIO and written atomically (atomic_file.h). Values are
// display-referred: sRGB encoded, alpha not premultiplied. Equal pixels give equal files.

/// Writes `width` x `height` pixels of `channels` (1 gray, 2 gray and alpha, 3 RGB, 4 RGBA)
/// interleaved values, rows from top to bottom.
[[nodiscard]] Status write_png(
    const std::string& path, int width, int height, int channels,
    std::span<const std::uint8_t> pixels);

/// The same with 16 bits per value, for gradients that would show banding with 8.
[[nodiscard]] Status write_png16(
    const std::string& path, int width, int height, int channels,
    std::span<const std::uint16_t> pixels);

/// The file of write_png as bytes, to embed in other files.
[[nodiscard]] Result<std::vector<std::uint8_t>>
png_bytes(int width, int height, int channels, std::span<const std::uint8_t> pixels);

}  // namespace limn
