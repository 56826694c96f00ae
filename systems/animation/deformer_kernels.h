#pragma once

#include "ecs/base/math.h"

#include <span>

namespace limn {

// Deformers (deformers.h) on the CPU: the reference for shaders/lib/deformers.glsl, and for other
// code that needs the deformed surface.

/// The point moved by the packed deformers.
[[nodiscard]] Vec3 deform_point(std::span<const Vec4> packed, const Vec3& point);

/// The unit normal of the deformed surface at a point with this normal, by central differences in
/// its tangent plane.
[[nodiscard]] Vec3
deform_normal(std::span<const Vec4> packed, const Vec3& point, const Vec3& normal);

/// deform_point for all points, in place; by SIMD, bit-identical to one by one.
void deform_points(std::span<const Vec4> packed, std::span<Vec3> points);
void deform_points_scalar(std::span<const Vec4> packed, std::span<Vec3> points);

}  // namespace limn
