#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn::test {

/// A normal map of floats, rows of `width` texels, which no rounding of bytes tilts.
inline ImageData image_of_normals(int width, const std::vector<Vec3>& normals) {
    ImageData image = {
        .name = "normals",
        .width = width,
        .height = static_cast<int>(normals.size()) / width,
        .format = PixelFormat::Rgba32F,
        .pixels = {}};
    for (const Vec3& normal : normals) {
        const Vec4 texel(normal * 0.5f + 0.5f, 1);
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(&texel);
        image.pixels.insert(image.pixels.end(), bytes, bytes + sizeof texel);
    }
    return image;
}

}  // namespace limn::test
