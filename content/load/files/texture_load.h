#pragma once

#include "content/load/files/image_load.h"

namespace limn {

/// decode_image() for a texture: an image in blocks (DDS) stays so, with its mip levels. `srgb`
/// counts for BC7, whatever the file says.
[[nodiscard]] Result<ImageData> decode_texture(
    std::span<const std::byte> bytes, const std::string& location, bool srgb,
    const ImageLimits& limits = {});

}  // namespace limn
