#pragma once

#include "ecs/components/surface.h"

#include <span>

namespace limn {

/// x^2 + y^2 of normals up to which the source's fit to the unit sphere (WrinkleMethod::Sphere) is
/// wrong by less than 8.76 degrees at any strength.
inline constexpr float kSteepestWrinkle = 0.6f;

/// Brings the normals of an 8-bit wrinkle map, flat at 128, back to x^2 + y^2 <= `most` (0 .. 1),
/// with their direction along the skin. Returns how many were beyond; 0 for other formats
/// (wrinkle.compression.map).
int limit_wrinkle_map(ImageData& map, float most = kSteepestWrinkle);

/// Writes the normals of `heights` [texels], row by row, into `map`, of 8 bits and that size, whose
/// edges meet: 128 stands for 0, so that flat is exact, and what rounding leaves over goes on to
/// the next texels (Floyd and Steinberg 1976). Means of slopes are right to far below a step of 8
/// bits; without, a fold would end in terraces. Alpha stays.
void write_wrinkle_map(ImageData& map, std::span<const float> heights);

}  // namespace limn
