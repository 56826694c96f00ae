#pragma once

#include "ecs/components/skeleton.h"

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// Vertices that follow joints and morph targets, on the CPU: the reference of the renderer's, and
// for picking and tests (char.skin-cpu). First the offsets of morph targets are added, in the
// mesh's own space; then a vertex goes where the mean of its joints' matrices takes it
// (char.skin-bone-offset), or the mean of their screw motions (L. Kavan et al., "Geometric Skinning
// with Approximate Dual Quaternion Blending", 2008), which keeps the volume of twisted joints but
// knows no scale. Normals go by the inverse transpose of the mean; where that flattens all to a
// line, the joint with the largest weight turns them.
//
// The inner loops come twice, as those of pose_kernels.h: with the widest vectors of the machine
// and as plain C++, `_scalar`. Both give the same bits, for any cut into ranges. The vectors do a
// batch of vertices at once: quickest where neighbors follow the same joints, at most four, slower
// where they follow different ones, and slowest where they also differ in how many.

/// Vertices at rest; all of one length.
struct RestVertices {
    std::span<const Vec3> positions;
    std::span<const Vec3> normals;   ///< unit
    std::span<const Vec4> tangents;  ///< unit; w is kept
};

/// Where moved vertices go; as many, and possibly the same.
struct MovedVertices {
    std::span<Vec3> positions;
    std::span<Vec3> normals;
    std::span<Vec4> tangents;
};

/// A screw motion: a unit quaternion and half its way times that.
struct DualQuaternion {
    Quat real = {1, 0, 0, 0};
    Quat dual = {0, 0, 0, 0};
};

/// palette[i] = joints[skin.joints[i]] * joint_from_mesh[i]: from the mesh at rest to where the
/// joint takes it.
void find_palette(const SkinData& skin, std::span<const Affine> joints, std::span<Affine> palette);

/// The same motions without scale and shear.
void find_dual_palette(std::span<const Affine> palette, std::span<DualQuaternion> duals);

/// Moves the vertices begin .. end by the mean of matrices. Those without influences stay.
void skin_linear(
    const SkinWeights& skin, std::span<const Affine> palette, const RestVertices& rest,
    const MovedVertices& moved, std::size_t begin, std::size_t end);
void skin_linear_scalar(
    const SkinWeights& skin, std::span<const Affine> palette, const RestVertices& rest,
    const MovedVertices& moved, std::size_t begin, std::size_t end);

/// Moves them by the mean of screw motions.
void skin_dual(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const RestVertices& rest,
    const MovedVertices& moved, std::size_t begin, std::size_t end);
void skin_dual_scalar(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const RestVertices& rest,
    const MovedVertices& moved, std::size_t begin, std::size_t end);

/// Adds weights[i] times target i to vertices, which hold those at rest; targets beyond the weights
/// are off. Normals and tangents are left as long as they become: unit again after skinning.
void add_morphs(
    std::span<const MorphTarget> morphs, std::span<const float> weights,
    const MovedVertices& vertices);

/// The `most` largest influences of each vertex, made to sum to 1 again (char.skin-limits).
[[nodiscard]] SkinWeights limit_influences(const SkinWeights& skin, std::size_t most);

}  // namespace limn
