#pragma once

#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"

#include <span>

namespace limn {

// The ripple height field of one body of water: creation, impulses, stepping, sampling. With
// reflecting borders volume is conserved: the sum of heights times the cell area is the submerged
// volume of bodies.

/// Largest number of cells of a grid; finer grids are coarsened.
inline constexpr int kMaxRippleCells = 2048 * 2048;
/// Largest number of substeps per step; faster waves are slowed down.
inline constexpr int kMaxRippleSubsteps = 16;
/// Cell budget of all impulses in a step; impulses beyond it are dropped.
inline constexpr std::int64_t kMaxPushedCells = 30'000'000;

/// A field at rest. Unbounded water needs a window, or there are no cells.
[[nodiscard]] RippleState make_ripples(const Water& water, const WaterRipples& ripples, float step);

/// Whether `state` has the layout that make_ripples would create, with arrays of consistent size,
/// as it may come from an untrusted file.
[[nodiscard]] bool fits(const RippleState& state, const Water& water, const WaterRipples& ripples);

/// Applies an impulse and returns the number of cells visited. Ignored if its center is outside the
/// grid or a number is not finite; the radius is at least 1.5 cells.
std::int64_t push_ripples(RippleState& state, const RippleImpulse& impulse);

/// Water displaced by a body: `volume` [m^3] spread over an ellipse.
struct WaterBulge {
    Vec2 center = {0, 0};  ///< in the water's local space, x and z [m]
    Vec2 radius = {1, 1};  ///< [m]
    float volume = 0;      ///< submerged [m^3]
};

/// Displaces water for bodies at new positions: it rises there and falls at their previous ones.
/// Only bodies with their center over the grid count.
void displace_ripples(RippleState& state, std::span<const WaterBulge> bulges);

/// Applies queued impulses, then advances the field by `step` [s]; does nothing unless `step` > 0.
/// Substeps are limited to 0.1 s, so a very long step may advance by less.
void step_ripples(RippleState& state, const WaterRipples& ripples, float step);

struct RipplePoint {
    float height = 0;     ///< [m]
    float velocity = 0;   ///< upward [m/s]
    Vec2 slope = {0, 0};  ///< by x and by z
};
/// At (x, z) in the water's local space: height and slope bilinear between cell centers, clamped to
/// the outermost centers near the border; 0 outside.
[[nodiscard]] RipplePoint sample_ripples(const RippleState& state, const Vec2& at);

/// Sum of heights times the area of a cell [m^3].
[[nodiscard]] double ripple_volume(const RippleState& state);

}  // namespace limn
