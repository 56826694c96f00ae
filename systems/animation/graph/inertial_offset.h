#pragma once

#include "ecs/base/math.h"

namespace limn {

// Inertialization: at a transition the character plays the new clip at once, plus the offset of the
// displayed pose from it, which decays smoothly to 0. After D. Bollo, "Inertialization:
// High-Performance Animation Transitions in Gears of War", GDC 2018. An offset is a direction, an
// amplitude x0 >= 0 along it and its rate v0; the amplitude is a polynomial of degree 5 in time:
//
//     x(0) = x0, x'(0) = min(v0, 0), x(t1) = x'(t1) = x''(t1) = 0, x''(0) >= 0 so that x >= 0
//
// A rate away from the target is dropped, and t1 shortened to -5 x0 / v0, which prevents overshoot.

/// Amplitude at `time` [s]; 0 from min(duration, -5 x0 / v0) on. Before 0 it continues linearly.
[[nodiscard]] float inertial_amplitude(float x0, float v0, float duration, float time);

/// Offset of a vector: x0 times its direction, and v0. `*_earlier`: `interval` [s] before.
[[nodiscard]] Vec4 inertial_shift(
    const Vec3& shown, const Vec3& shown_earlier, const Vec3& target, const Vec3& target_earlier,
    float interval);
[[nodiscard]] Vec3 apply_shift(const Vec4& shift, const Vec3& target, float duration, float time);

/// Offset of a rotation: its axis times the angle x0, 0 .. pi [rad], and v0 [rad/s] about that
/// axis. On the side of the parent: shown = offset * target.
[[nodiscard]] Vec4 inertial_turn(
    const Quat& shown, const Quat& shown_earlier, const Quat& target, const Quat& target_earlier,
    float interval);
[[nodiscard]] Quat apply_turn(const Vec4& turn, const Quat& target, float duration, float time);

/// Offset of a number, signed, and its rate away from 0.
[[nodiscard]] Vec2 inertial_number(
    float shown, float shown_earlier, float target, float target_earlier, float interval);
[[nodiscard]] float apply_number(const Vec2& offset, float target, float duration, float time);

}  // namespace limn
