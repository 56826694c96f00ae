#pragma once

#include "ecs/components/wrinkle.h"

#include <cstdint>
#include <span>

namespace limn {

// How much skin is compressed across its wrinkles, from triangles to vertices to the intensity of
// the wrinkles (wrinkle.compression.*).
//
//     ratio = |x e1' + y e2'|^2,    ratio of a vertex = sum of weight * ratio
//     intensity = 2 / (1 + (lambda ratio)^beta) - 1
//
// x, y are the direction across wrinkles in the edges of the triangle at rest, e1' and e2' the
// edges now. That is the square of its longest chord in that direction by what it was at rest,
// since a triangle deforms affinely: no chord needs to be found, and only shortening in that
// direction counts, neither shortening along the wrinkles nor shear that keeps the chord.

/// `across` has a direction per vertex, of either sign: the mean of three is used, without its part
/// along the normal. A triangle has none where they cancel or are parallel to the normal, where it
/// has no area, and where a coordinate is not finite or an index beyond the positions. Vertices at
/// one position have the same triangles, so that UV seams do not show.
[[nodiscard]] WrinkleRest make_wrinkle_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const Vec3> across, WrinkleWeight weight = WrinkleWeight::Angle);

/// Square of the length of each triangle across its wrinkles, 1 at rest: `ratio` has one element
/// per triangle. 1 where it has no direction or a position is not finite.
void find_compression(
    const WrinkleRest& rest, std::span<const Vec3> deformed, std::span<float> ratio);

/// Weighted means of the triangles at each vertex; 1 at a vertex without any.
void average_compression(
    const WrinkleRest& rest, std::span<const float> ratio, std::span<float> vertices);

/// How strong wrinkles are, -1 .. 1, falling with `ratio` >= 0; negative: stretched. 0 at 1 /
/// lambda; the slope there is -beta lambda / 2. lambda > 1 lets some compression pass before
/// wrinkles begin, lambda < 1 shows them at rest; both > 0. After Volino and Magnenat-Thalmann
/// (wrinkle.compression.intensity).
[[nodiscard]] float wrinkle_intensity(float ratio, float lambda, float beta);

}  // namespace limn
