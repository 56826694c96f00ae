#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace limn {

// The surface where a function of space is 0, as triangles: naive surface nets (S. F. F. Gibson,
// "Constrained Elastic Surface Nets", 1998). Every cell that the surface crosses has one vertex;
// then vertices slide along the surface toward the middle of their neighbors and back onto it, so
// that triangles become even. Closed and without an edge of more than two triangles wherever the
// surface is not thinner than a cell.

/// Less than 0 inside; away from the surface at most as large as the distance to it.
using SignedDistance = std::function<float(const Vec3&)>;

struct ImplicitGrid {
    Bounds box;          ///< holds the whole surface [m]
    float cell = 0.01f;  ///< [m], > 0
    int relaxations = 4;
};

struct ImplicitMesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;           ///< unit, outward
    std::vector<std::uint32_t> indices;  ///< three a triangle, counter-clockwise from outside
};

[[nodiscard]] ImplicitMesh mesh_surface(const SignedDistance& distance, const ImplicitGrid& grid);

/// The gradient of `distance` at `p`, unit; by differences over `step` to both sides.
[[nodiscard]] Vec3 surface_normal(const SignedDistance& distance, const Vec3& p, float step);

}  // namespace limn
