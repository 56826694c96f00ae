#pragma once

#include "ecs/base/result.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

struct ImageData;

// Loads untrusted images: PNG through png_file.h, EXR through exr_file.h, the first level of DDS
// through dds_file.h (texture_load.h keeps the blocks of textures), JPEG, BMP, WebP and Radiance
// HDR through OpenImageIO (image_codec.h); the format is detected from the first bytes, never from
// the name. The header is checked against limits before pixels are allocated, and a
// truncated file is an error. Gray becomes RGB, a missing alpha is 1, alpha is not premultiplied. 8
// and 16 bit integers become Rgba8, half Rgba16F, all other floats Rgba32F.

/// Limits on untrusted images.
struct ImageLimits {
    int max_size = 16384;                             ///< pixels along either side
    std::int64_t max_pixels = std::int64_t{1} << 27;  ///< width * height; 0.5 GiB as Rgba8
};

/// Reads the file `path`. `srgb` marks 8 bit colors for decoding by the GPU; floats are linear
/// already. Fails with "path: found X, expected Y".
[[nodiscard]] Result<ImageData>
load_image(const std::string& path, bool srgb, const ImageLimits& limits = {});

/// The same from memory; `location` is the prefix of error messages and the name of the image.
[[nodiscard]] Result<ImageData> decode_image(
    std::span<const std::byte> bytes, const std::string& location, bool srgb,
    const ImageLimits& limits = {});

/// Why an image of this size is refused; empty if it is accepted. Inline, because limn_codecs calls
/// it and links nothing of Limn.
[[nodiscard]] inline std::string
image_size_error(std::int64_t width, std::int64_t height, const ImageLimits& limits) {
    if (width > 0 && height > 0 && width <= limits.max_size && height <= limits.max_size
        && width * height <= limits.max_pixels) {
        return {};
    }
    return fmt::format(
        "found {} x {} pixels, expected at most {} along a side and {} in all", width, height,
        limits.max_size, limits.max_pixels);
}

/// Replaces NaN by 0 and infinities by +-65504 in a float image; returns how many there were.
std::size_t replace_non_finite(ImageData& image);

}  // namespace limn
