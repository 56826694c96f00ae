#pragma once

#include "systems/animation/skin_kernels.h"

namespace limn::skin {

// Scalar version of the kernels of skin_kernels.h, per vertex: the bit-exact reference of the SIMD
// version, and its fallback for degenerate means.

/// Squared length of a transformed normal, relative to the matrix, below which it is degenerate.
inline constexpr float kFlat = 1e-12f;
/// Squared length below which a vector has no direction.
inline constexpr float kNoLength = 1e-30f;
/// Squared length below which the mean of dual quaternions is degenerate (they cancel).
inline constexpr float kNoMotion = 1e-12f;

/// Mean of the dual quaternions of a vertex, not normalized; if they cancel, the first of them.
[[nodiscard]] DualQuaternion
mean_motion(const SkinWeights& skin, std::span<const DualQuaternion> palette, std::size_t v);

/// Whether q is in the opposite hemisphere of p, so that -q, the same rotation, must be blended.
[[nodiscard]] inline bool turns_away(const Quat& p, const Quat& q) {
    return (p.x * q.x + p.z * q.z) + (p.y * q.y + p.w * q.w) < 0.0f;
}

/// Transformed normal of a vertex.
[[nodiscard]] Vec3 moved_normal(
    const SkinWeights& skin, std::span<const Affine> palette, const Vec3& rest, std::size_t v);
[[nodiscard]] Vec3 moved_normal(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const Vec3& rest,
    std::size_t v);

}  // namespace limn::skin
