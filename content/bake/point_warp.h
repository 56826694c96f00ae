#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// A smooth map of space that interpolates pairs of points and bends as little as possible in
// between: the biharmonic spline in three dimensions (Duchon 1977),
//
//     f(p) = a + A p + sum over i of w_i phi(|p - c_i|),    phi(r) = r,
//
// or with phi(r) = r^3, which has no kinks at the points: for motion past them. The weights are
// orthogonal to the affine functions. Affine maps are reproduced exactly.

enum class WarpKernel : std::uint8_t { Linear, Cubic };

struct PointWarp {
    std::vector<Vec3> centers;
    std::vector<Vec3> weights;  ///< one per center
    Affine affine;
    WarpKernel kernel = WarpKernel::Linear;
};

/// The warp that maps from[i] to to[i], solved in double precision in O(n^3). Fails when there are
/// fewer than four points, two coincide, or all are coplanar.
[[nodiscard]] Result<PointWarp> make_point_warp(
    std::span<const Vec3> from, std::span<const Vec3> to, WarpKernel kernel = WarpKernel::Linear);

[[nodiscard]] Vec3 warp_point(const PointWarp& warp, const Vec3& p);

}  // namespace limn
