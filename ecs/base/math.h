#pragma once

#include "ecs/base/field_type.h"

#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#define GLM_FORCE_XYZW_ONLY
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstdint>

namespace limn {

// Vectors and matrices are GLM's. SI units, radians, right-handed, +y up; matrices multiply column
// vectors and are named right to left: clip_from_world * world_from_mesh. Depth is reversed: 1 at
// the near plane, 0 at infinity.
// Techniques: anim.quat-to-matrix, shade.vector-ops

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using IVec2 = glm::ivec2;
using IVec3 = glm::ivec3;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;
using Quat = glm::quat;  ///< Quat(w, x, y, z); Quat(1, 0, 0, 0) is no rotation

inline constexpr float kPi = 3.14159265358979323846f;

[[nodiscard]] constexpr float radians(float degrees) {
    return degrees * (kPi / 180.0f);
}
[[nodiscard]] constexpr float degrees(float radians) {
    return radians * (180.0f / kPi);
}

template <typename T>
[[nodiscard]] constexpr T square(T x) {
    return x * x;
}

/// Of a value that scripts may have set to anything.
[[nodiscard]] inline float finite_or(float value, float otherwise) {
    return std::isfinite(value) ? value : otherwise;
}
/// Whether all components are finite, and their sum is.
template <glm::length_t n>
[[nodiscard]] bool is_finite(const glm::vec<n, float>& v) {
    float sum = v[0];
    for (glm::length_t i = 1; i < n; ++i) {
        sum += v[i];
    }
    return std::isfinite(sum);
}

/// x / |x|, or `fallback` if x is zero, tiny or not finite.
[[nodiscard]] inline Vec3 normalize_or(const Vec3& x, const Vec3& fallback) {
    const float length2 = glm::dot(x, x);
    return length2 > 1e-30f && std::isfinite(length2) ? x / std::sqrt(length2) : fallback;
}

/// A unit vector perpendicular to unit `n` (Duff et al. 2017).
[[nodiscard]] inline Vec3 any_perpendicular(const Vec3& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    return {1.0f + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

/// An affine map as the three upper rows of its 4x4 matrix: 48 bytes, the layout of GLSL's
/// `vec4 row[3]` in std430. world = (dot(row[0], p1), dot(row[1], p1), dot(row[2], p1)), p1 = (p,
/// 1).
struct Affine {
    Vec4 row[3] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

[[nodiscard]] inline Affine
affine_from(const Vec3& position, const Quat& rotation, const Vec3& scale) {
    const Mat3 r = glm::mat3_cast(rotation);
    Affine a;
    for (int i = 0; i < 3; ++i) {
        a.row[i] = {r[0][i] * scale.x, r[1][i] * scale.y, r[2][i] * scale.z, position[i]};
    }
    return a;
}

/// a after b: transform_point(a * b, p) = transform_point(a, transform_point(b, p)).
[[nodiscard]] inline Affine operator*(const Affine& a, const Affine& b) {
    Affine product;
    for (int i = 0; i < 3; ++i) {
        product.row[i] = a.row[i].x * b.row[0] + a.row[i].y * b.row[1] + a.row[i].z * b.row[2]
                         + Vec4(0, 0, 0, a.row[i].w);
    }
    return product;
}

[[nodiscard]] inline Vec3 transform_point(const Affine& a, const Vec3& p) {
    const Vec4 p1(p, 1.0f);
    return {glm::dot(a.row[0], p1), glm::dot(a.row[1], p1), glm::dot(a.row[2], p1)};
}

/// Transforms a direction: without translation.
[[nodiscard]] inline Vec3 transform_vector(const Affine& a, const Vec3& v) {
    const Vec4 v0(v, 0.0f);
    return {glm::dot(a.row[0], v0), glm::dot(a.row[1], v0), glm::dot(a.row[2], v0)};
}

[[nodiscard]] inline Mat4 to_mat4(const Affine& a) {
    return glm::transpose(Mat4(a.row[0], a.row[1], a.row[2], Vec4(0, 0, 0, 1)));
}

/// Drops the last row of `m`, which must be (0, 0, 0, 1).
[[nodiscard]] inline Affine to_affine(const Mat4& m) {
    const Mat4 t = glm::transpose(m);
    return {{t[0], t[1], t[2]}};
}

/// Axis-aligned box. The default is empty: min > max.
struct Bounds {
    Vec3 min = Vec3(INFINITY);
    Vec3 max = Vec3(-INFINITY);
};

[[nodiscard]] inline bool is_empty(const Bounds& b) {
    return !(b.min.x <= b.max.x);
}
[[nodiscard]] inline Vec3 center(const Bounds& b) {
    return 0.5f * (b.min + b.max);
}
[[nodiscard]] inline Vec3 half_extent(const Bounds& b) {
    return 0.5f * (b.max - b.min);
}
inline void grow(Bounds& b, const Vec3& p) {
    b.min = glm::min(b.min, p);
    b.max = glm::max(b.max, p);
}
inline void grow(Bounds& b, const Bounds& other) {
    b.min = glm::min(b.min, other.min);
    b.max = glm::max(b.max, other.max);
}

// Field types for reflection.
template <>
inline constexpr FieldType field_type_of<Vec2> = FieldType::Vec2;
template <>
inline constexpr FieldType field_type_of<Vec3> = FieldType::Vec3;
template <>
inline constexpr FieldType field_type_of<Vec4> = FieldType::Vec4;
template <>
inline constexpr FieldType field_type_of<Quat> = FieldType::Quat;
template <>
inline constexpr FieldType field_type_of<IVec2> = FieldType::IVec2;
template <>
inline constexpr FieldType field_type_of<IVec3> = FieldType::IVec3;
template <>
inline constexpr FieldType field_type_of<Mat3> = FieldType::Mat3;
template <>
inline constexpr FieldType field_type_of<Mat4> = FieldType::Mat4;
template <>
inline constexpr FieldType field_type_of<Affine> = FieldType::Affine;

}  // namespace limn
