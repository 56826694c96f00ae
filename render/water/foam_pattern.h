#pragma once

#include <cstdint>
#include <vector>

namespace limn {

// How foam breaks up: a tile whose texels say how long foam stays there while the water's cover
// fades. Bubbles gather in the walls between cells, large and small ones (after S. Worley, "A
// Cellular Texture Basis Function", 1996). Every value is as frequent as any other, so that of a
// cover c the share c of all texels exceeds 1 - c.

inline constexpr int kFoamPatternSide = 256;  ///< [texels]

/// Squares of kFoamPatternSide texels a side, half as many and so on to one, 0 .. 255: each is the
/// mean of the one before, with values made even again. They repeat without a seam.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> make_foam_pattern();

}  // namespace limn
