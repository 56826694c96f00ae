#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// The texture that replaces fine geometry (relief.map-format; Policarpo and Oliveira 2005), RGBA,
// linear, rows from top to bottom:
//
//     R, G   tangent-space normal x and y as (n + 1) / 2: red to the right, green up the image;
//            z = sqrt(1 - x^2 - y^2)
//     A      depth of the surface, 0 on the polygon, 1 deepest (at the relief depth of the
//     material) B      by layout:
//       Single  normal z as (n + 1) / 2
//       Double  depth of the back surface, from the polygon, too, >= A. Where there is nothing, A =
//               B = 1
//       Cone    relaxed cone ratio r / h (Policarpo and Oliveira 2007), 0 .. 1: the cone with its
//               apex on the surface of this texel that opens toward the viewer has radius r, in
//               texture coordinates, at height h above the apex, in units of the full depth. Not
//               the square root: bytes resolve 1/255.
//
// Mip levels average depth; normals are averaged as vectors of unit length and normalized again
// (relief.filter). A cone of the next level is the narrowest of the four, so that it stays empty.

enum class ReliefLayout : std::uint8_t { Single, Double, Cone };

/// R, G, B and A of each texel, or any other map of up to four channels while it is made.
struct BakedMap {
    int width = 0;
    int height = 0;
    std::vector<Vec4> texels = {};

    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width)
               + static_cast<std::size_t>(x);
    }
};

[[nodiscard]] BakedMap make_baked_map(int width, int height, const Vec4& value = Vec4(0));

/// The surface at a texel.
struct ReliefTexel {
    Vec3 normal = {0, 0, 1};  ///< unit, z >= 0
    float depth = 1;
    float back = 1;        ///< Double
    float cone_ratio = 0;  ///< Cone
};

[[nodiscard]] Vec4 encode_relief(const ReliefTexel& texel, ReliefLayout layout);
[[nodiscard]] ReliefTexel decode_relief(const Vec4& rgba, ReliefLayout layout);

/// (n + 1) / 2, and back to a unit vector.
[[nodiscard]] Vec3 encode_normal(const Vec3& normal);
[[nodiscard]] Vec3 decode_normal(const Vec3& rgb);

/// The next level: half the size, rounded down, at least 1. In the layout Double, texels without
/// anything do not count.
[[nodiscard]] BakedMap next_relief_level(const BakedMap& map, ReliefLayout layout);

/// The first `channels` of each texel, interleaved, with 8 or 16 bits; NaN is 0.
[[nodiscard]] std::vector<std::uint8_t> map_bytes(const BakedMap& map, int channels);
[[nodiscard]] std::vector<std::uint16_t> map_words(const BakedMap& map, int channels);

}  // namespace limn
