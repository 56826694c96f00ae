#pragma once

#include "systems/animation/skin_kernels.h"

namespace limn::skin {

// The plain form of the kernels of skin_kernels.h, vertex by vertex: what their vectors have to
// give, to the last bit, and what they ask for where a mean is no motion.

/// Squared length, as a share of what the matrix does to volumes: below, there is no normal.
inline constexpr float kFlat = 1e-12f;
/// Squared length of a vector without a direction.
inline constexpr float kNoLength = 1e-30f;
/// Squared length of a mean of screw motions that cancel each other.
inline constexpr float kNoMotion = 1e-12f;

/// The mean of the screw motions of a vertex; where they cancel each other, the first of them.
[[nodiscard]] DualQuaternion
mean_motion(const SkinWeights& skin, std::span<const DualQuaternion> palette, std::size_t v);

/// Whether q turns away from p, so that -q, which turns like q, is the one to blend with p.
[[nodiscard]] inline bool turns_away(const Quat& p, const Quat& q) {
    return (p.x * q.x + p.z * q.z) + (p.y * q.y + p.w * q.w) < 0.0f;
}

/// Where the normal of a vertex goes.
[[nodiscard]] Vec3 moved_normal(
    const SkinWeights& skin, std::span<const Affine> palette, const Vec3& rest, std::size_t v);
[[nodiscard]] Vec3 moved_normal(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const Vec3& rest,
    std::size_t v);

}  // namespace limn::skin
