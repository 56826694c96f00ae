#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

struct ImageData;

// Pictures from files: PNG, JPEG, BMP, WebP and Radiance HDR through OpenImageIO, EXR through
// exr_file.h; told apart by their first bytes, never by their names. Untrusted: the header is
// checked against limits before anything of the picture's size is allocated, and a picture that
// ends early is an error, not half a picture. Gray becomes RGB, a missing alpha is 1, alpha is not
// multiplied into the color. 8 and 16 bit integers become Rgba8, half Rgba16F, all other floats
// Rgba32F.

/// What a picture may cost.
struct ImageLimits {
    int max_size = 16384;                             ///< pixels along either side
    std::int64_t max_pixels = std::int64_t{1} << 27;  ///< width * height; 0.5 GiB as Rgba8
};

/// Reads the file `path`. `srgb` marks 8 bit colors for decoding by the GPU; floats are linear
/// already. Fails with "path: found X, expected Y".
[[nodiscard]] Result<ImageData>
load_image(const std::string& path, bool srgb, const ImageLimits& limits = {});

/// The same from memory; `place` begins the message of an error and names the image.
[[nodiscard]] Result<ImageData> decode_image(
    std::span<const std::byte> bytes, const std::string& place, bool srgb,
    const ImageLimits& limits = {});

/// Replaces what is not finite in a picture of floats, NaN by 0 and infinities by the largest half
/// of their sign; returns how many values there were.
std::size_t replace_non_finite(ImageData& image);

}  // namespace limn
