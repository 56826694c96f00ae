#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Normals of a triangle mesh from which the tangent planes of its patches follow
// (surface_patches.h). Patches meet smoothly where every triangle at a vertex faces along the
// normal there. The mean of their normals, weighted by area, fails that where small triangles turn
// away from large ones, as in the corner of a mouth; the axis of the narrowest cone around their
// normals does not, whenever some direction exists that all of them face: R. Aubry and R. Loehner,
// "On the 'most normal' normal", 2008.

/// The direction whose least cosine with `directions` is largest: the axis of their smallest cone.
/// All are unit. Zero if there are none. Takes O(n^4) time.
[[nodiscard]] Vec3 axis_of_cone(std::span<const Vec3> directions);

/// Fills one unit normal per position: the mean by area, which gives way to the axis of the cone as
/// a triangle turns away from it, without a jump unless it collapses. Where no direction is faced
/// by all triangles, as where two sides of a fold touch, the mean is kept. `corners`: three per
/// triangle.
void make_patch_normals(
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
    std::vector<Vec3>& normals);

}  // namespace limn
