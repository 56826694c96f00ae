#pragma once

#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"

#include <span>

namespace limn {

// The height field of a body of water, by itself: made, pushed, stepped and asked. With reflecting
// borders no water is made or lost but for what bodies push up: the sum of heights times the area
// of a cell is their volume under water.

/// Cells of a grid, at most; a finer one is made coarser.
inline constexpr int kMaxRippleCells = 2048 * 2048;
/// Sub-steps of a step, at most; quicker waves are slowed down.
inline constexpr int kMaxRippleSubsteps = 16;
/// Cells that the impulses of a step push, at most, all together; those left then are dropped.
inline constexpr std::int64_t kMaxPushedCells = 30'000'000;

/// At rest. A Water without end needs a window; without one: no cells.
[[nodiscard]] RippleState make_ripples(const Water& water, const WaterRipples& ripples, float step);

/// Whether `state` is the one that make_ripples makes now, but for what has moved in it: as large,
/// and whole, whatever file it has come from.
[[nodiscard]] bool fits(const RippleState& state, const Water& water, const WaterRipples& ripples);

/// Pushes the water as `impulse` says; returns how many cells that were looked at. The middle of it
/// must be over the grid; numbers that are not finite do nothing; a radius of less than 1.5 cells
/// is as large.
std::int64_t push_ripples(RippleState& state, const RippleImpulse& impulse);

/// What a body pushes up: `volume` [m^3] spread over an ellipse.
struct WaterBulge {
    Vec2 center = {0, 0};  ///< in the water's own space, x and z [m]
    Vec2 radius = {1, 1};  ///< [m]
    float volume = 0;      ///< under water [m^3]
};

/// The water makes room for bodies at new places: it rises where they have come and falls where
/// they were. Only those whose middle is over the grid count.
void displace_ripples(RippleState& state, std::span<const WaterBulge> bulges);

/// Moves the field on by `step` [s]: impulses first. Without a step, > 0, they wait. A sub-step
/// is a tenth of a second at most, so a longer step may pass for a shorter one.
void step_ripples(RippleState& state, const WaterRipples& ripples, float step);

struct RipplePoint {
    float height = 0;     ///< [m]
    float velocity = 0;   ///< upward [m/s]
    Vec2 slope = {0, 0};  ///< by x and by z
};
/// At (x, z) in the water's own space: bilinear between the middles of cells, of slopes too; as at
/// the outermost middles between them and the border; 0 outside.
[[nodiscard]] RipplePoint sample_ripples(const RippleState& state, const Vec2& at);

/// Sum of heights times the area of a cell [m^3].
[[nodiscard]] double ripple_volume(const RippleState& state);

}  // namespace limn
