#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace limn {

// Rotations as unit quaternions (w, v) = (cos(angle / 2), sin(angle / 2) axis). q and -q turn
// alike; which of the two a key holds decides the way between two keys, so lists of keys are
// aligned once. Products, conjugates, turning a vector and matrices are GLM's: p * q turns by q
// first.
// After K. Shoemake, "Animating Rotation with Quaternion Curves" (1985) and "Quaternion Calculus
// and Fast Animation" (1987), as chapter 7 of A. Watt, F. Policarpo, "Advanced Game Development
// with Programmable Graphics Hardware" (2005) tells them.

/// q / |q|, or no rotation where q is zero, tiny or not finite.
[[nodiscard]] inline Quat unit_or_none(const Quat& q) {
    const float length2 = glm::dot(q, q);
    return length2 > 1e-30f && std::isfinite(length2) ? q / std::sqrt(length2) : Quat(1, 0, 0, 0);
}

/// By `angle` [rad] about `axis` of any length; no rotation about an axis of length 0.
[[nodiscard]] inline Quat rotation_about(const Vec3& axis, float angle) {
    const Vec3 unit = normalize_or(axis, Vec3(0));
    return unit == Vec3(0) ? Quat(1, 0, 0, 0)
                           : Quat(std::cos(angle / 2), std::sin(angle / 2) * unit);
}

struct AxisAngle {
    Vec3 axis = {1, 0, 0};  ///< unit
    float angle = 0.0f;     ///< 0 .. 2 pi [rad]
};

/// The inverse of rotation_about(). No rotation is about +x; accurate there, as an arc cosine is
/// not.
[[nodiscard]] inline AxisAngle axis_angle(const Quat& q) {
    const Vec3 v(q.x, q.y, q.z);
    return {normalize_or(v, Vec3(1, 0, 0)), 2.0f * std::atan2(glm::length(v), q.w)};
}

/// Logarithm of a unit quaternion, without its zero real part: the axis times half the angle [rad].
/// A whole turn, (-1, 0, 0, 0), is about +x.
[[nodiscard]] inline Vec3 log_rotation(const Quat& q) {
    const Vec3 v(q.x, q.y, q.z);
    const float sine = glm::length(v);
    if (sine < 1e-18f) {
        return q.w < 0.0f ? Vec3(kPi, 0, 0) : v;
    }
    return v * (std::atan2(sine, q.w) / sine);
}

/// The inverse of log_rotation().
[[nodiscard]] inline Quat exp_rotation(const Vec3& half) {
    const float angle = glm::length(half);
    const float factor = angle < 1e-4f ? 1.0f : std::sin(angle) / angle;
    return {std::cos(angle), factor * half};
}

/// The rotation in `matrix` without its scale and shear: the columns made perpendicular, the first
/// one kept. None if it mirrors or flattens space, or is not finite.
[[nodiscard]] inline std::optional<Quat> rotation_in(const Mat3& matrix) {
    const Vec3 x = normalize_or(matrix[0], Vec3(0));
    const Vec3 y = normalize_or(matrix[1] - glm::dot(matrix[1], x) * x, Vec3(0));
    const Vec3 z = glm::cross(x, y);
    const float along = glm::dot(z, matrix[2]);
    if (!(along > 1e-6f * glm::length(matrix[2]))) {
        return std::nullopt;
    }
    return glm::normalize(glm::quat_cast(Mat3(x, y, z)));
}

/// -q where that is nearer to `p` (anim.shortest-arc).
[[nodiscard]] inline Quat near_to(const Quat& p, const Quat& q) {
    return glm::dot(p, q) < 0.0f ? -q : q;
}

/// Turns signs so that each is near the one before it. The rotations stay what they are.
inline void align_rotations(std::span<Quat> keys) {
    for (std::size_t i = 1; i < keys.size(); ++i) {
        keys[i] = near_to(keys[i - 1], keys[i]);
    }
}

/// On the straight line from a to b, the short way, back on the sphere: slower at the ends than in
/// the middle by cos^2 of a quarter of the angle (anim.quat-lerp).
[[nodiscard]] inline Quat nlerp(const Quat& a, const Quat& b, float u) {
    return unit_or_none((1.0f - u) * a + u * near_to(a, b));
}

/// On the great arc from a to b, whichever way their signs say; with constant speed. Between a and
/// -a, which no arc connects, it stays at the nearer one.
[[nodiscard]] inline Quat slerp_along(const Quat& a, const Quat& b, float u) {
    const float cosine = glm::dot(a, b);
    if (cosine > 1.0f - 1e-6f) {
        return unit_or_none((1.0f - u) * a + u * b);
    }
    if (cosine < -1.0f + 1e-6f) {
        return u < 0.5f ? a : b;
    }
    const float omega = std::acos(cosine);
    const float scale = 1.0f / std::sin(omega);
    return (std::sin((1.0f - u) * omega) * scale) * a + (std::sin(u * omega) * scale) * b;
}

/// On the shorter arc, with constant speed; a at u = 0, b or -b at 1 (anim.slerp).
[[nodiscard]] inline Quat slerp(const Quat& a, const Quat& b, float u) {
    return slerp_along(a, near_to(a, b), u);
}

/// The inner point of squad() at a key between two others, all aligned: the tangent there is that
/// from `before` to `after`.
[[nodiscard]] inline Quat squad_point(const Quat& before, const Quat& key, const Quat& after) {
    const Quat back = glm::conjugate(key);
    return key * exp_rotation(-0.25f * (log_rotation(back * after) + log_rotation(back * before)));
}

/// From key a to key b through the inner points of both: smooth over keys at equal steps of time
/// (anim.squad). At the first and the last key of a list the key itself is the inner point.
[[nodiscard]] inline Quat
squad(const Quat& a, const Quat& inner_a, const Quat& inner_b, const Quat& b, float u) {
    return slerp_along(
        slerp_along(a, b, u), slerp_along(inner_a, inner_b, u), 2.0f * u * (1.0f - u));
}

}  // namespace limn
