#pragma once

#include "ecs/components/furrows.h"

#include <vector>

namespace limn {

// The height field and the normals of furrowed skin: GENERATE and REMAKE of Bando 2001, sections
// 3.3 and 4.1. Growing furrows takes most of the time; noise and relief can be changed without it.
//
// Normals are those of a smooth surface (s, t, f(s, t)) perturbed by the relief, as a surface
// gradient (equal to Bando's Equation 4.11, and to Mikkelsen 2010): the tangential part of the
// gradient is subtracted from the normal,
//
//     n'' = n - (g - (g . n) n),  g = bump (dh/ds, dh/dt, 0)
//
// with forward differences per pixel, so that `bump` is the height of the relief in pixels. n'' . n
// is 1: a normal never flips.
//
// Images have rows from top to bottom; t, and y of a normal, point upwards. Results are
// bit-identical for any number of threads.

[[nodiscard]] FurrowGrowth grow_furrows(const FurrowMap& map, const FurrowStyle& style);

/// The height of `growth` minus r times the noise of the style, r uniform in 0 .. 1 per pixel. May
/// be negative.
[[nodiscard]] std::vector<float>
add_furrow_noise(const FurrowGrowth& growth, const FurrowStyle& style);

/// The normals of the smooth surface, interpolated over each triangle; unit. (0, 0, 1) beyond it.
[[nodiscard]] std::vector<Vec3>
make_furrow_base_normals(const FurrowMap& map, const FurrowGrowth& growth);

/// Unit `n` minus the tangential part of the gradient (slope.x, slope.y, 0); not normalized.
[[nodiscard]] Vec3 perturb_furrow_normal(const Vec3& n, const Vec2& slope);

/// The base normals perturbed by `height`; unit. There is no slope toward pixels beyond the surface
/// or, unless it repeats, the image.
[[nodiscard]] std::vector<Vec3> make_furrow_normals(
    const FurrowMap& map, const FurrowGrowth& growth, const std::vector<float>& height, float bump);

}  // namespace limn
