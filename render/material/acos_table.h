#pragma once

#include "ecs/base/math.h"

#include <vector>

namespace limn {

// Two functions of a light's or a view's direction in a texture, for hardware on which a lookup is
// cheaper than arithmetic (engine.opt-lut): acos(x / sqrt(1 - y^2)), the angle about an axis of
// which y is the component, and acos(y). Both have an infinite slope where they end, so that a
// linear filter errs there: by 0.0027 rad at most up to 0.9 of the end, 0.1 rad at it, with 256
// texels along a side. shaders/lib/acos_table.glsl reads it.

inline constexpr int kAcosTexels = 256;

/// `size` x `size` pairs of both [rad], row by row of rising y; the first and the last texel of
/// each side are at -1 and 1. Quotients beyond -1 .. 1 count as that.
[[nodiscard]] std::vector<Vec2> make_acos_table(int size = kAcosTexels);

/// What a bilinear filter reads at x, y in -1 .. 1.
[[nodiscard]] Vec2 sample_acos_table(const std::vector<Vec2>& table, int size, float x, float y);

}  // namespace limn
