#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace limn {

// Triangulates the zero level set of a function: naive surface nets (S. F. F. Gibson, "Constrained
// Elastic Surface Nets", 1998). Every cell that the surface crosses has one vertex; vertices are
// then relaxed toward the centroid of their neighbors and projected back onto the surface, to even
// out the triangles. Closed and 2-manifold wherever the surface is not thinner than a cell.

/// < 0 inside; outside it must not exceed the distance to the surface.
using SignedDistance = std::function<float(const Vec3&)>;

struct ImplicitGrid {
    Bounds box;          ///< contains the whole surface [m]
    float cell = 0.01f;  ///< [m], > 0
    int relaxations = 4;
};

struct ImplicitMesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;           ///< unit, outward
    std::vector<std::uint32_t> indices;  ///< three per triangle, counter-clockwise from outside
};

[[nodiscard]] ImplicitMesh mesh_surface(const SignedDistance& distance, const ImplicitGrid& grid);

/// Moves vertices halfway to the mean of their neighbors, then back onto the surface, by half a
/// `cell` at once.
void relax_on_surface(ImplicitMesh& mesh, const SignedDistance& distance, float cell, int rounds);

/// Unit gradient of `distance` at `p`, by central differences over +-`step`.
[[nodiscard]] Vec3 surface_normal(const SignedDistance& distance, const Vec3& p, float step);

}  // namespace limn
