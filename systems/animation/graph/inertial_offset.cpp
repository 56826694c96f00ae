#include "systems/animation/graph/inertial_offset.h"

#include "ecs/base/rotation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.blend

namespace limn {

namespace {

constexpr float kSmallestOffset = 1e-6f;  ///< [m], [rad]; smaller ones have no direction
constexpr float kSmallestRate = 1e-4f;    ///< [m/s], [rad/s]; of rounding

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

float inertial_drift(float duration, float time) {
    if (time <= 0.0f || !(time < duration)) {
        return time <= 0.0f ? time : 0.0f;
    }
    const float s = time / duration;
    return time * std::max(((8.0f - 3.0f * s) * s - 6.0f) * s * s + 1.0f, 0.0f);
}

Vec3 inertial_vector(const InertialOffset& offset, float duration, float time) {
    const float x0 = glm::length(offset.offset);
    if (!(x0 > kSmallestOffset)) {
        return offset.rate * inertial_drift(duration, time);
    }
    const Vec3 direction = offset.offset / x0;
    const float inward = std::min(glm::dot(offset.rate, direction), 0.0f);
    return direction * inertial_amplitude(x0, inward, duration, time)
           + (offset.rate - inward * direction) * inertial_drift(duration, time);
}

InertialOffset inertial_shift(
    const Vec3& shown, const Vec3& shown_earlier, const Vec3& target, const Vec3& target_earlier,
    float interval) {
    const Vec3 offset = shown - target;
    return {offset, (offset - (shown_earlier - target_earlier)) / interval};
}

Vec3 apply_shift(const InertialOffset& shift, const Vec3& target, float duration, float time) {
    return target + inertial_vector(shift, duration, time);
}

InertialOffset inertial_turn(
    const Quat& shown, const Quat& shown_earlier, const Quat& target, const Quat& target_earlier,
    float interval) {
    const Quat offset = to_same_hemisphere(Quat(1, 0, 0, 0), shown * glm::conjugate(target));
    const Quat earlier = to_same_hemisphere(offset, shown_earlier * glm::conjugate(target_earlier));
    const Vec3 turn = 2.0f * log_rotation(offset);
    return {turn, (turn - 2.0f * log_rotation(earlier)) / interval};
}

Quat apply_turn(const InertialOffset& turn, const Quat& target, float duration, float time) {
    const Vec3 offset = inertial_vector(turn, duration, time);
    return offset == Vec3(0) ? target : normalize_or_identity(exp_rotation(0.5f * offset) * target);
}

bool is_negligible(const InertialOffset& offset) {
    return glm::length(offset.offset) <= kSmallestOffset
           && glm::length(offset.rate) <= kSmallestRate;
}

}  // namespace limn
