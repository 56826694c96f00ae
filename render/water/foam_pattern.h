#pragma once

#include <cstdint>
#include <vector>

namespace limn {

// Foam dissolve pattern: a tile whose texels are thresholds, so that foam breaks up as coverage
// decreases. Bubbles gather along the walls between cells, large and small ones (after S. Worley,
// "A Cellular Texture Basis Function", 1996). Values are uniformly distributed, so that at coverage
// c the fraction c of all texels exceeds 1 - c.

inline constexpr int kFoamPatternSide = 256;  ///< [texels]

/// Full mip chain from kFoamPatternSide texels per side down to one, values 0 .. 255: each level
/// averages the previous one and is equalized again. Tiles seamlessly.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> make_foam_pattern();

}  // namespace limn
