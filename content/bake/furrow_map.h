#pragma once

#include "content/bake/furrow_field.h"
#include "ecs/base/result.h"
#include "ecs/components/furrows.h"

#include <span>

namespace limn {

struct MeshData;

// Flattens a mesh with its two fields to an image on which furrows are drawn.
//
// Planar (hands, feet): (s, t) = (x, y), viewed from +z; oblique faces are distorted.
// Cylinder (arms, legs): s is the angle around y, scaled by the mean radius so that lengths along s
// and t agree; the image is as wide as the circumference and repeats to the right, so that there is
// no seam. Uv: the texture coordinates of the mesh; directions by the Jacobian of each triangle,
// with their magnitudes; normals are (0, 0, 1), tangent space.
// After Bando 2001, section 3.2.

/// The angle [rad] around y of a point, from +z over +x, in (0, 2 pi]; 0 on the axis.
[[nodiscard]] float cylinder_angle(const Vec3& p);
/// A vector at the angle `s` in unrolled axes: along s, up, and outwards.
[[nodiscard]] Vec3 unroll_vector(const Vec3& v, float s);

struct FurrowMapShape {
    FurrowProjection projection = FurrowProjection::Uv;
    int size = 512;      ///< width of the image [px], 1 .. kMaxFurrowSize
    bool tiles = false;  ///< Uv: the image repeats in both directions
};

inline constexpr int kMaxFurrowSize = 4096;

/// Needs normals, and for Uv texture coordinates. On a cylinder the height of the image follows
/// from the mesh, otherwise it is square. Skips triangles without an area, back faces in a planar
/// projection, and triangles larger than eight images of a tiling texture. Fails if none remains,
/// or a cylinder would need more than kMaxFurrowSize rows.
[[nodiscard]] Result<FurrowMap> make_furrow_map(
    const MeshData& mesh, std::span<const FurrowVectors> field, const FurrowMapShape& shape);

}  // namespace limn
