#pragma once

#include "ecs/base/math.h"

#include <vector>

namespace limn {

// Waves over an uneven bottom (water.shallow-refraction): the period stays, length and speed follow
// from the depth (water_dispersion.h), so crests turn toward the shore. The phase S of a train that
// comes in from deep water obeys the eikonal equation |grad S| = k(depth); along rays Snell's law
// holds, sin(angle) / speed is the same everywhere. Neither diffraction nor reflection; where rays
// cross, S is that of the first to arrive.

/// Depth of water at the points of a grid [m]; at most 0: land. Point (i, j) is at j * points.x +
/// i.
struct DepthGrid {
    IVec2 points = {0, 0};
    float cell = 1;  ///< between points [m]
    std::vector<float> depth{};
};

/// At the points of a DepthGrid.
struct WaveTrain {
    std::vector<float> number{};     ///< k [rad/m]; 0 on land
    std::vector<float> phase{};      ///< S [rad], without omega t; on land as if shallow
    std::vector<float> amplitude{};  ///< share of that where it came in: 0 on land, else 1
};

/// Water counts as at least so deep [m].
inline constexpr float kLeastWaveDepth = 0.05f;

/// The train of `period` [s] that comes in as a plane wave in `direction` from +x toward +z [rad],
/// over the side of the grid that it leaves behind most, as deep as its deepest point. Phase 0 is
/// at point (0, 0). Marched from that side, row by row, by Godunov's scheme; over the other two
/// sides the bottom is taken to go on as it is at them.
[[nodiscard]] WaveTrain refract_waves(const DepthGrid& grid, float period, float direction);

/// A ray of the same waves: from `from` [m] in `direction` [rad] for `length` [m], a point each
/// `step` [m]. Ends at land and at the edge of the grid, whose point (0, 0) is at the origin.
[[nodiscard]] std::vector<Vec2> trace_wave_ray(
    const DepthGrid& grid, float period, const Vec2& from, float direction, float length,
    float step);

/// Angle to the shore's normal over depth `to` of waves that have `angle` over depth `from` [rad].
[[nodiscard]] float snell_angle(float angle, float from, float to, float period);

}  // namespace limn
