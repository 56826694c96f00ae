#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace limn {

// Rotations as unit quaternions (w, v) = (cos(angle / 2), sin(angle / 2) axis). q and -q are the
// same rotation, but their signs decide which arc interpolation takes between two keys, so lists of
// keys are aligned once. Products, conjugates, rotation of vectors and matrices are GLM's: p * q
// applies q first.
// After K. Shoemake, "Animating Rotation with Quaternion Curves" (1985) and "Quaternion Calculus
// and Fast Animation" (1987), as presented in chapter 7 of A. Watt, F. Policarpo, "Advanced Game
// Development with Programmable Graphics Hardware" (2005).
// Techniques: anim.quat-algebra, anim.quat-axis-angle, anim.quat-from-matrix, anim.quat-lerp,
//     anim.quat-rotate, anim.shortest-arc, anim.slerp, anim.squad

/// q / |q|, or the identity if q is zero, tiny or not finite.
[[nodiscard]] inline Quat normalize_or_identity(const Quat& q) {
    const float length2 = glm::dot(q, q);
    return length2 > 1e-30f && std::isfinite(length2) ? q / std::sqrt(length2) : Quat(1, 0, 0, 0);
}

/// Rotation by `angle` [rad] about `axis` of any length; the identity for a zero axis.
[[nodiscard]] inline Quat rotation_about(const Vec3& axis, float angle) {
    const Vec3 unit = normalize_or(axis, Vec3(0));
    return unit == Vec3(0) ? Quat(1, 0, 0, 0)
                           : Quat(std::cos(angle / 2), std::sin(angle / 2) * unit);
}

struct AxisAngle {
    Vec3 axis = {1, 0, 0};  ///< unit
    float angle = 0.0f;     ///< 0 .. 2 pi [rad]
};

/// The inverse of rotation_about(). The identity has axis +x; accurate for small angles, where an
/// arc cosine is not.
[[nodiscard]] inline AxisAngle axis_angle(const Quat& q) {
    const Vec3 v(q.x, q.y, q.z);
    return {normalize_or(v, Vec3(1, 0, 0)), 2.0f * std::atan2(glm::length(v), q.w)};
}

/// Logarithm of a unit quaternion, without its zero real part: the axis times half the angle [rad].
/// A full turn, (-1, 0, 0, 0), has axis +x.
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

/// The rotation of `matrix` without scale and shear, by Gram-Schmidt on its columns, the first one
/// kept. nullopt if the matrix is a reflection, singular or not finite.
[[nodiscard]] inline std::optional<Quat> extract_rotation(const Mat3& matrix) {
    const Vec3 x = normalize_or(matrix[0], Vec3(0));
    const Vec3 y = normalize_or(matrix[1] - glm::dot(matrix[1], x) * x, Vec3(0));
    const Vec3 z = glm::cross(x, y);
    const float along = glm::dot(z, matrix[2]);
    if (!(along > 1e-6f * glm::length(matrix[2]))) {
        return std::nullopt;
    }
    return glm::normalize(glm::quat_cast(Mat3(x, y, z)));
}

/// q or -q, whichever is closer to `p` (anim.shortest-arc).
[[nodiscard]] inline Quat to_same_hemisphere(const Quat& p, const Quat& q) {
    return glm::dot(p, q) < 0.0f ? -q : q;
}

/// Flips signs so that each key is closest to the previous one. The rotations do not change.
inline void align_rotations(std::span<Quat> keys) {
    for (std::size_t i = 1; i < keys.size(); ++i) {
        keys[i] = to_same_hemisphere(keys[i - 1], keys[i]);
    }
}

/// Normalized linear interpolation along the shorter arc: slower at the ends than halfway by
/// cos^2 of a quarter of the angle (anim.quat-lerp).
[[nodiscard]] inline Quat nlerp(const Quat& a, const Quat& b, float u) {
    return normalize_or_identity((1.0f - u) * a + u * to_same_hemisphere(a, b));
}

/// Slerp along the great arc from a to b that their signs select, with constant speed. Between a
/// and -a, where the arc is undefined, it returns the nearer end.
[[nodiscard]] inline Quat slerp_along(const Quat& a, const Quat& b, float u) {
    const float cosine = glm::dot(a, b);
    if (cosine > 1.0f - 1e-6f) {
        return normalize_or_identity((1.0f - u) * a + u * b);
    }
    if (cosine < -1.0f + 1e-6f) {
        return u < 0.5f ? a : b;
    }
    const float omega = std::acos(cosine);
    const float scale = 1.0f / std::sin(omega);
    return (std::sin((1.0f - u) * omega) * scale) * a + (std::sin(u * omega) * scale) * b;
}

/// Slerp along the shorter arc, with constant speed; a at u = 0, b or -b at 1 (anim.slerp).
[[nodiscard]] inline Quat slerp(const Quat& a, const Quat& b, float u) {
    return slerp_along(a, to_same_hemisphere(a, b), u);
}

/// The inner control point of squad() at `key` between two others, all aligned: the tangent at the
/// key points from `before` to `after`.
[[nodiscard]] inline Quat squad_point(const Quat& before, const Quat& key, const Quat& after) {
    const Quat back = glm::conjugate(key);
    return key * exp_rotation(-0.25f * (log_rotation(back * after) + log_rotation(back * before)));
}

/// Spherical quadrangle interpolation from key a to key b with the inner control points of both:
/// smooth across keys at equal time steps (anim.squad). At the first and the last key of a list the
/// key itself is the inner point.
[[nodiscard]] inline Quat
squad(const Quat& a, const Quat& inner_a, const Quat& inner_b, const Quat& b, float u) {
    return slerp_along(
        slerp_along(a, b, u), slerp_along(inner_a, inner_b, u), 2.0f * u * (1.0f - u));
}

}  // namespace limn
