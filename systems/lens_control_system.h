#pragma once

namespace limn {

class World;

// The rings of a lens in somebody's hands: Input::lens pulls focus, opens the aperture and the
// shutter: distance and f-number by factors, the shutter's angle by degrees, so that each turns as
// fast anywhere on its scale. Whoever pulls focus turns off the Autofocus beside the lens.

/// Turns the lenses of active cameras, and the shutter of MotionBlur if there is one.
void turn_lenses(World& world);

/// Focus [m] after `dt` [s] of a ring turned at `turn`, -1 .. 1, > 0 toward infinity.
[[nodiscard]] float turn_focus(float focus, float turn, float dt);
/// The f-number, likewise; > 0 opens.
[[nodiscard]] float turn_aperture(float f_number, float turn, float dt);
/// The shutter [deg]; > 0 keeps it open longer.
[[nodiscard]] float turn_shutter(float shutter, float turn, float dt);

}  // namespace limn
