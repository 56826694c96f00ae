#pragma once

#include "content/bake/bake_rows.h"
#include "content/bake/relief_map.h"
#include "content/bake/tile_surface.h"
#include "ecs/base/math.h"

#include <cstdint>

namespace limn {

// Omni-directional displacement maps: what each view ray sees of a tile that repeats, by the
// position at which it meets the polygon and by its direction (odd.map-format, odd.bake).
//
// RGB is the tangent-space normal as (n + 1) / 2, A the distance along the ray from the polygon to
// the surface divided by 8 relief depths, clamped to 1, which is also a miss. 32 x 32 positions and
// 16 x 16 directions make 512 x 512 texels. Positions are (x, y) in texture coordinates, y down.
//
// A direction R points from the surface to the viewer, in tangent space with green up, and is
// indexed by two angles (odd.direction),
//
//     R = (cos a sin b, cos b, sin a sin b),    0 <= a, b <= pi,
//
// stored as fractions of pi. Cell i of 16 has the angle pi (i + 1/2) / 16. Distances and directions
// along the horizon are coarse: the maps suit low relief.

inline constexpr int kOddPositions = 32;
inline constexpr int kOddDirections = 16;
inline constexpr float kOddDistance = 8;  ///< relief depths at which A is 1

/// a / pi and b / pi of the unit direction to the viewer; where it is along the bitangent, a is
/// 1/2.
[[nodiscard]] Vec2 odd_angles(const Vec3& to_viewer);
[[nodiscard]] Vec3 odd_direction(const Vec2& angles);

/// Cell of an angle in 0 .. 1.
[[nodiscard]] int odd_cell(float angle);

/// Which pair of indices selects the block of texels, and which the texel in it (odd.order).
enum class OddOrder : std::uint8_t {
    Directions,  ///< a block per direction: an image of the tile from there
    Positions,   ///< a block per position: what it sees in all directions
};

/// Texel of the packed map: position (x, y), direction (a, b).
[[nodiscard]] IVec2 odd_texel(const IVec2& position, const IVec2& direction, OddOrder order);

/// Texture coordinates of the packed map, position and angles in 0 .. 1.
[[nodiscard]] Vec2 odd_coordinates(const Vec2& position, const Vec2& angles, OddOrder order);

/// The map in the other order.
[[nodiscard]] BakedMap odd_reordered(const BakedMap& map, OddOrder from);

/// Rays from the polygon along -R.
[[nodiscard]] BakedMap bake_odd(
    const TileSurface& tile, const TileCaster& caster, OddOrder order,
    const RowProgress& progress = {});

/// The angles by cosines, without acos (odd.index-map): at texel ((A + 1) / 2, (B + 1) / 2) with
/// A = R.x and B = R.y, RG holds both in steps of 1/255 and BA the rest, divided by 0.005. To be
/// sampled without filtering; outside the unit disc it holds the nearest direction on the horizon.
[[nodiscard]] BakedMap make_odd_index_map(int size = 256);
[[nodiscard]] Vec2 decode_odd_index(const Vec4& rgba);

}  // namespace limn
