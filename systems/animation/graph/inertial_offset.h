#pragma once

#include "ecs/base/math.h"
#include "ecs/components/motion_graph.h"

namespace limn {

// Inertialization: at a transition the character plays the new clip at once, plus the offset of the
// displayed pose from it, which decays smoothly to 0. After D. Bollo, "Inertialization:
// High-Performance Animation Transitions in Gears of War", GDC 2018: the amplitude x of an offset,
// along its direction, is a polynomial of degree 5 in time with
//
//     x(0) = x0, x'(0) = v0 <= 0, x(t1) = x'(t1) = x''(t1) = 0, x''(0) >= 0 so that x >= 0
//
// and t1 shortened to -5 x0 / v0, which prevents overshoot. He drops rates away from the target and
// across the offset. Here these go on and fade as well, by the same polynomial with x0 = 0, so that
// the velocity of the displayed pose is continuous: a leg that swings finishes its swing.

/// Amplitude at `time` [s]; 0 from min(duration, -5 x0 / v0) on, and for x0 <= 0. Positive v0 count
/// as 0. Before time 0 it continues linearly.
[[nodiscard]] float inertial_amplitude(float x0, float v0, float duration, float time);

/// Way of what starts at offset 0 with rate 1 [s]: at most 0.2 `duration`, and 0 at its end.
[[nodiscard]] float inertial_drift(float duration, float time);

/// An offset at `time` [s] after it was `offset.offset` and changed at `offset.rate` [1/s].
[[nodiscard]] Vec3 inertial_vector(const InertialOffset& offset, float duration, float time);

/// Offset of a vector. `*_earlier`: `interval` [s] before.
[[nodiscard]] InertialOffset inertial_shift(
    const Vec3& shown, const Vec3& shown_earlier, const Vec3& target, const Vec3& target_earlier,
    float interval);
[[nodiscard]] Vec3
apply_shift(const InertialOffset& shift, const Vec3& target, float duration, float time);

/// Offset of a rotation: its axis times its angle, 0 .. pi [rad], on the side of the parent: shown
/// = offset * target.
[[nodiscard]] InertialOffset inertial_turn(
    const Quat& shown, const Quat& shown_earlier, const Quat& target, const Quat& target_earlier,
    float interval);
[[nodiscard]] Quat
apply_turn(const InertialOffset& turn, const Quat& target, float duration, float time);

/// Whether there is nothing to decay.
[[nodiscard]] bool is_negligible(const InertialOffset& offset);

}  // namespace limn
