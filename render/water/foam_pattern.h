#pragma once

#include <cstdint>
#include <vector>

namespace limn {

// How foam breaks up: a tile whose texels say how long foam stays there while the water's cover
// fades. Bubbles gather in the walls between cells, large and small ones (after S. Worley, "A
// Cellular Texture Basis Function", 1996). Every value is as frequent as any other, so that of a
// cover c the share c of all texels exceeds 1 - c.

inline constexpr int kFoamPatternSide = 256;  ///< [texels]
inline constexpr float kFoamTile = 6.0f;      ///< side [m]; lib/water_foam.glsl has it too

/// Square of kFoamPatternSide texels, 0 .. 255; repeats without a seam.
[[nodiscard]] std::vector<std::uint8_t> make_foam_pattern();

}  // namespace limn
