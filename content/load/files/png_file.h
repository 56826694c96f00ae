#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

struct ImageData;
struct ImageLimits;

// PNG files through libpng: encoded and decoded in memory, written atomically (atomic_file.h).
// Values are display-referred: sRGB encoded, alpha not premultiplied. Equal pixels give equal
// files.

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

/// Reads an untrusted PNG of any kind as Rgba8; `location` is the prefix of error messages and the
/// name of the image. Fails if the file is truncated or corrupt or exceeds the limits.
[[nodiscard]] Result<ImageData> decode_png(
    std::span<const std::byte> bytes, const std::string& location, const ImageLimits& limits);

/// RGBA, rows from top to bottom.
struct Png16 {
    int width = 0;
    int height = 0;
    std::vector<std::uint16_t> pixels = {};
};

/// The same with 16 bits; of 8 bits, 255 becomes 65535.
[[nodiscard]] Result<Png16> decode_png16(
    std::span<const std::byte> bytes, const std::string& location, const ImageLimits& limits);

}  // namespace limn
