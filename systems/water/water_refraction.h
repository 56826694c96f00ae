#pragma once

#include "ecs/base/math.h"

#include <vector>

namespace limn {

// Refraction of waves over an uneven bottom (water.shallow-refraction): the period is constant,
// length and speed follow from the depth (water_dispersion.h), so crests turn toward the shore. The
// phase S of a train that arrives from deep water obeys the eikonal equation |grad S| = k(depth);
// along rays Snell's law holds: sin(angle) / speed is constant. Neither diffraction nor reflection;
// where rays cross, S is that of the first arrival.

/// Water depth at grid points [m]; <= 0: land. Point (i, j) has index j * points.x + i.
struct DepthGrid {
    IVec2 points = {0, 0};
    float cell = 1;  ///< distance between points [m]
    std::vector<float> depth{};
};

/// Values at the points of a DepthGrid.
struct WaveTrain {
    std::vector<float> number{};     ///< k [rad/m]; 0 on land
    std::vector<float> phase{};      ///< S [rad], without omega t; land counts as shallow water
    std::vector<float> amplitude{};  ///< relative to the incoming one: 0 on land, else 1
};

/// Smaller depths count as this [m].
inline constexpr float kMinWaveDepth = 0.05f;

/// Train of `period` [s] that enters as a plane wave in `direction`, from +x toward +z [rad], over
/// the grid side that faces it most, with the depth of that side's deepest point. Phase 0 is at
/// point (0, 0). Marched row by row from that side with Godunov's scheme; the bottom is
/// extrapolated beyond the two lateral sides.
[[nodiscard]] WaveTrain refract_waves(const DepthGrid& grid, float period, float direction);

/// Traces a ray of such waves from `from` [m] in `direction` [rad] over `length` [m], with a point
/// every `step` [m]. Ends at land and at the edge of the grid, whose point (0, 0) is at the origin.
[[nodiscard]] std::vector<Vec2> trace_wave_ray(
    const DepthGrid& grid, float period, const Vec2& from, float direction, float length,
    float step);

/// Angle to the shore's normal at depth `to` of waves that have `angle` at depth `from` [rad].
[[nodiscard]] float snell_angle(float angle, float from, float to, float period);

}  // namespace limn
