#pragma once

#include "ecs/base/math.h"
#include "ecs/components/skeleton.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Surface-oriented free-form deformation (face.soffd): K. Singh and E. Kokkevis, "Skinning
// Characters Using Surface-Oriented Free-Form Deformations", 2000. Each face k of a control surface
// has a frame F_k. A point x follows the faces that are near it,
//
//     x' = sum over k of w_k D_k x,    D_k = F_k(now) F_k(rest)^-1,    sum of w_k = 1.
//
// Since the weights never change, this is linear blend skinning with one joint per face:
// SkinWeights hold the w_k, a SkinData the F_k(rest)^-1 and a Pose the F_k(now). So it runs on CPU
// and GPU with velocities and normals, at the cost of skinning.
//
// The paper's weights are not normalized and would not reproduce the rest pose. A face that faces
// away from a point's normal counts as farther away, so that touching lips do not stick together.
// Where only the nearest `count` faces are kept, their weights are reduced by that of the nearest
// dropped one, so that the list changes from point to point without a crease.

/// Frame of a triangle: origin a, axes b - a, c - a and their cross product, scaled to grow like a
/// length. A triangle without area has no third axis.
[[nodiscard]] Affine face_frame(const Vec3& a, const Vec3& b, const Vec3& c);

/// 1 / (1 + distance^locality): 1 at 0, 1/2 at a distance of 1.
[[nodiscard]] float face_weight(float distance, float locality);

/// Faces of triangles `indices` that have a frame, as three vertices each.
[[nodiscard]] std::vector<std::uint32_t>
faces_with_area(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

/// Influences of the faces on each of `points`, at most `count` >= 1 each; distances are in mean
/// edges of the faces, of which a face that faces the opposite direction is kAway farther away.
/// `normals`: unit, one per point, or empty. At least one face, at most 65536. Time grows as points
/// * faces.
inline constexpr float kAway = 4.0f;
[[nodiscard]] SkinWeights bind_to_faces(
    std::span<const Vec3> points, std::span<const Vec3> normals, std::span<const Vec3> positions,
    std::span<const std::uint32_t> corners, float locality, std::size_t count);

/// The skin that belongs to bind_to_faces.
[[nodiscard]] SkinData
make_face_skin(std::span<const Vec3> positions, std::span<const std::uint32_t> corners);

/// The frames of all faces, to `frames`, one each.
void compute_face_frames(
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
    std::span<Affine> frames);

}  // namespace limn
