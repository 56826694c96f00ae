#pragma once

#include "ecs/components/wrinkle.h"

#include <span>

namespace limn {

// How steep folds must be for skin to keep its length (the method Isometric). Skin with an excess
// length e = rest / now - 1 folds until its profile is as long as it was at rest:
//
//     mean of sqrt(1 + (I slope)^2) = 1 + e
//
// over the slopes of its wrinkle map. For a sine of amplitude A and wavelength w this is the
// elliptic integral of its arc length, A / w ~ sqrt(e (1 + 3/4 e)) / pi.

/// The factors I for a map with these slopes. Flat ones, between regions, are ignored. All 0 if
/// every slope is flat.
[[nodiscard]] FoldTable make_fold_table(std::span<const Vec2> slopes);

/// The factor for an excess length `e`, clamped to 0 .. 1.
[[nodiscard]] float fold_strength(const FoldTable& table, float e);

/// Squared length ratio relative to unfolded skin: `ratio` >= 0 is relative to the length at rest,
/// at which skin is already too long by `resting` 0 .. 1 (WrinkleState::resting).
[[nodiscard]] float rested_ratio(float ratio, float resting);

/// The excess length, at most 1, that becomes folds at a squared length ratio `ratio` >= 0: the
/// fraction `folding` of the shortening beyond `slack`, which skin absorbs without folding.
[[nodiscard]] float fold_excess(float ratio, float slack, float folding);

/// Slopes of an 8-bit tangent-space normal map, row by row. 128 is 0, so that flat is exact. Empty
/// for other formats.
[[nodiscard]] std::vector<Vec2> wrinkle_slopes(const ImageData& map);

/// The same for a map with two layers, x and y of the normals of the first in red and green, of the
/// second in blue and alpha: the slopes of both, interleaved per texel.
[[nodiscard]] std::vector<Vec2> layered_slopes(const ImageData& map);

}  // namespace limn
