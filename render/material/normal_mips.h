#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// The mip levels of normal maps. A texel of a coarser level has the mean direction of the texels of
// the image that it covers, as a unit vector: the mean itself is shorter the more they differ, and
// glGenerateTextureMipmap stores that. Means are of the image, not of the level before, in which
// all normals have the same length again. Opposite normals, whose mean is 0, become (0, 0, 1).
//
// Materials with NormalMips::Plain leave their maps to glGenerateTextureMipmap, since shaders
// normalize what they read: that has the same directions but for rounding.
//
// NormalMips other than Plain also store how much the normals differ, as the standard deviations of
// their slopes, in a second image of the same size: its spread. Its red and green are those along
// tangent and bitangent, blue is their correlation: 0 is -1, 255 is 1.
//
//     Toksvig  sigma^2 = (1 - L) / L, L the length of the mean: shininess n becomes
//              1 / (1 / n + sigma^2) = L n / (L + n (1 - L)), alike in all directions
//     Lean     covariance of the slopes, which a roughness alpha has as alpha^2 / 2
//
// After Toksvig, "Mipmapping Normal Maps", 2005, and Olano and Baker, "LEAN Mapping", 2010. Unlike
// theirs, the second moments are about the mean of each texel, which 8 bits store well; what means
// of neighboring texels differ by is up to widen_roughness() (lib/material.glsl).

struct NormalLevel {
    std::vector<std::uint8_t> normals;  ///< in the format of the image; empty for the image itself
    std::vector<std::uint8_t> spread;   ///< RGBA8; empty for NormalMips::Plain
};

/// All levels of a valid image that is not in blocks, the first of which is the image itself.
[[nodiscard]] std::vector<NormalLevel> make_normal_levels(const ImageData& image, NormalMips mips);

}  // namespace limn
