#pragma once

#include "ecs/components/surface.h"
#include "ecs/components/wrinkle_limit.h"

#include <span>

namespace limn {

/// Clamps the normals of an 8-bit wrinkle map, flat at 128, to x^2 + y^2 <= `max_square` (0 .. 1),
/// keeping their direction along the skin. Returns how many were steeper; 0 for other formats
/// (wrinkle.compression.map).
int limit_wrinkle_map(ImageData& map, float max_square = kSteepestWrinkle);

/// Writes the normals of `heights` [texels], row by row, into `map`, of 8 bits and the same size,
/// which tiles: 128 stands for 0, so that flat is exact, and rounding errors diffuse to the next
/// texels (Floyd and Steinberg 1976). Mean slopes are then accurate to far below a step of 8 bits;
/// otherwise a fold would end in terraces. Alpha is unchanged.
void write_wrinkle_map(ImageData& map, std::span<const float> heights);

}  // namespace limn
