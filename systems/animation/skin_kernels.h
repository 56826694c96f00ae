#pragma once

#include "ecs/components/skeleton.h"

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// Skinning and morph targets on the CPU: the reference for the renderer's, and for picking and
// tests (char.skin-cpu). Morph offsets are added first, in the mesh's local space; then each vertex
// is transformed by the weighted mean of its joint matrices (char.skin-bone-offset), or of their
// dual quaternions (L. Kavan et al., "Geometric Skinning with Approximate Dual Quaternion
// Blending", 2008), which preserves the volume of twisted joints but does not support scale.
// Normals use the inverse transpose of the mean; if that is degenerate, the rotation of the joint
// with the largest weight.
//
// Like those of pose_kernels.h, the inner loops have a SIMD version and a plain C++ one, `_scalar`,
// with bit-identical results for any split into ranges. SIMD processes a batch of vertices at once:
// fastest if neighbors have the same joints, at most four, slower if their joints differ, and
// slowest if the number of joints differs, too.

/// Undeformed vertices; all spans have the same length, or only positions are not empty.
struct RestVertices {
    std::span<const Vec3> positions;
    std::span<const Vec3> normals;   ///< unit
    std::span<const Vec4> tangents;  ///< unit; w is kept
};

/// Destination of deformed vertices; the same lengths, possibly the same memory.
struct SkinnedVertices {
    std::span<Vec3> positions;
    std::span<Vec3> normals;
    std::span<Vec4> tangents;
};

/// A rigid transform: a unit quaternion `real`, and `dual` = half the translation times `real`.
struct DualQuaternion {
    Quat real = {1, 0, 0, 0};
    Quat dual = {0, 0, 0, 0};
};

/// Skinning matrices palette[i] = joints[skin.joints[i]] * joint_from_mesh[i] of the first joints
/// of the skin.
void compute_skin_palette(
    const SkinData& skin, std::span<const Affine> joints, std::span<Affine> palette);

/// The same as dual quaternions, without scale and shear.
void compute_dual_palette(std::span<const Affine> palette, std::span<DualQuaternion> duals);

/// Linear blend skinning of the vertices begin .. end. Those without influences are not moved.
void skin_linear(
    const SkinWeights& skin, std::span<const Affine> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end);
void skin_linear_scalar(
    const SkinWeights& skin, std::span<const Affine> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end);

/// Dual quaternion skinning, likewise.
void skin_dual(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end);
void skin_dual_scalar(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end);

/// Adds weights[i] times target i to vertices, which hold the undeformed ones; targets without a
/// weight are off. Normals and tangents are not normalized here but by skinning.
void add_morphs(
    std::span<const MorphTarget> morphs, std::span<const float> weights,
    const SkinnedVertices& vertices);

/// Keeps the `count` largest influences of each vertex, renormalized (char.skin-limits).
[[nodiscard]] SkinWeights limit_influences(const SkinWeights& skin, std::size_t count);

}  // namespace limn
