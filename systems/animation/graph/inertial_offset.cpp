#include "systems/animation/graph/inertial_offset.h"

#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.blend

namespace limn {

namespace {

constexpr float kSmallestOffset = 1e-6f;  ///< [m], [rad]; smaller ones have no direction

}  // namespace

float inertial_amplitude(float x0, float v0, float duration, float time) {
    if (!(x0 > kSmallestOffset) || !(duration > 0.0f)) {
        return 0.0f;
    }
    const float rate = std::min(v0, 0.0f);
    if (time <= 0.0f) {
        return x0 + rate * time;
    }
    const float t1 = rate < 0.0f ? std::min(duration, -5.0f * x0 / rate) : duration;
    if (!(time < t1)) {
        return 0.0f;
    }
    // In units of t1: time s in 0 .. 1, v = v0 t1, a = a0 t1^2.
    const float s = time / t1;
    const float v = rate * t1;
    const float a = std::max(0.0f, -8.0f * v - 20.0f * x0);
    const float c5 = -0.5f * (a + 6.0f * v + 12.0f * x0);
    const float c4 = 0.5f * (3.0f * a + 16.0f * v + 30.0f * x0);
    const float c3 = -0.5f * (3.0f * a + 12.0f * v + 20.0f * x0);
    return std::max(((((c5 * s + c4) * s + c3) * s + 0.5f * a) * s + v) * s + x0, 0.0f);
}

Vec4 inertial_shift(
    const Vec3& shown, const Vec3& shown_earlier, const Vec3& target, const Vec3& target_earlier,
    float interval) {
    const Vec3 offset = shown - target;
    const float x0 = glm::length(offset);
    if (!(x0 > kSmallestOffset)) {
        return Vec4(0);
    }
    const float earlier = glm::dot(shown_earlier - target_earlier, offset) / x0;
    return {offset, (x0 - earlier) / interval};
}

Vec3 apply_shift(const Vec4& shift, const Vec3& target, float duration, float time) {
    const Vec3 offset(shift);
    const float x0 = glm::length(offset);
    const float x = inertial_amplitude(x0, shift.w, duration, time);
    return x == 0.0f ? target : target + offset * (x / x0);
}

Vec4 inertial_turn(
    const Quat& shown, const Quat& shown_earlier, const Quat& target, const Quat& target_earlier,
    float interval) {
    Quat offset = shown * glm::conjugate(target);
    offset = offset.w < 0.0f ? -offset : offset;
    const AxisAngle turn = axis_angle(offset);
    if (!(turn.angle > kSmallestOffset)) {
        return Vec4(0);
    }
    const Quat before = to_same_hemisphere(offset, shown_earlier * glm::conjugate(target_earlier));
    const Vec3 v(before.x, before.y, before.z);
    const float earlier = 2.0f * std::atan2(glm::dot(v, turn.axis), before.w);
    return {turn.angle * turn.axis, (turn.angle - earlier) / interval};
}

Quat apply_turn(const Vec4& turn, const Quat& target, float duration, float time) {
    const Vec3 offset(turn);
    const float x0 = glm::length(offset);
    const float x = inertial_amplitude(x0, turn.w, duration, time);
    return x == 0.0f ? target
                     : normalize_or_identity(exp_rotation(offset * (0.5f * x / x0)) * target);
}

Vec2 inertial_number(
    float shown, float shown_earlier, float target, float target_earlier, float interval) {
    const float offset = shown - target;
    const float sign = offset < 0.0f ? -1.0f : 1.0f;
    return {offset, sign * (offset - (shown_earlier - target_earlier)) / interval};
}

float apply_number(const Vec2& offset, float target, float duration, float time) {
    const float x = inertial_amplitude(std::abs(offset.x), offset.y, duration, time);
    return offset.x < 0.0f ? target - x : target + x;
}

}  // namespace limn
