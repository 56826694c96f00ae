#pragma once

#include "ecs/components/wrinkle.h"

#include <span>

namespace limn {

// How steep folds must be for skin to keep its length (the method Isometric). Skin that is e = rest
// / now - 1 too long for its place folds until its profile is as long as it was at rest:
//
//     mean of sqrt(1 + (I slope)^2) = 1 + e
//
// over the slopes of its wrinkle map. For a sine of amplitude A and wavelength w this is the
// elliptic integral of its arc length, A / w ~ sqrt(e (1 + 3/4 e)) / pi.

/// The factors I for a map with these slopes, of which flat ones do not count: they are between
/// regions. All 0 if none is left.
[[nodiscard]] FoldTable make_fold_table(std::span<const Vec2> slopes);

/// The factor for an excess of length `e`: 0 below 0, that at 1 above 1.
[[nodiscard]] float fold_strength(const FoldTable& table, float e);

/// Square of the length of skin by that which would not fold: `ratio` >= 0 by what it was, and too
/// long for that by `resting` 0 .. 1 (WrinkleState::resting).
[[nodiscard]] float rested_ratio(float ratio, float resting);

/// The excess, 1 at most, that becomes folds when lengths are `ratio` >= 0 of what they were,
/// squared: after `slack`, which passes without, `share` of the shortening.
[[nodiscard]] float fold_excess(float ratio, float slack, float share);

/// Slopes of an 8-bit tangent-space normal map, row by row. 128 is 0, so that flat is exact. Empty
/// for other formats.
[[nodiscard]] std::vector<Vec2> wrinkle_slopes(const ImageData& map);

/// The same of a map with two layers, x and y of the normals of the first in red and green, of the
/// second in blue and alpha: the slopes of both, texel by texel.
[[nodiscard]] std::vector<Vec2> layered_slopes(const ImageData& map);

}  // namespace limn
