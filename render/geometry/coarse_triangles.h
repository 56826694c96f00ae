#pragma once

#include "ecs/components/surface.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

// Levels of detail of shadow casters: fewer triangles over the same vertices, with the geometric
// error, the largest distance from the mesh. A shadow map draws the coarsest level whose error is
// below Shadow::detail texels.
//
// Edges are collapsed in order of their quadric error (Garland and Heckbert 1997); where that goes
// no further, or less well, vertices are merged by the cells of a grid (Rossignac and Borrel 1993);
// both by meshoptimizer. Only rest positions count: parts of a skin that touch at rest may stay
// joined, which shows only where the map resolves the contact. Meshes with morph targets, whose
// lips and eyelids open, use edge collapse only.

/// Maximum number of coarser levels per mesh.
inline constexpr std::size_t kMaxCoarseLevels = 7;

struct CoarseTriangles {
    std::vector<std::uint32_t> indices;  ///< three per triangle
    float error = 0;  ///< largest distance of a mesh vertex, at rest, from these [m]
};

/// Coarser levels of a mesh with valid indices, each with at most 3/4 of the triangles of the
/// previous one; none for a mesh that is already small, has positions that are not finite, or has
/// more than 200,000 triangles in connected components that average fewer than 12.
[[nodiscard]] std::vector<CoarseTriangles> simplify_triangles(const MeshData& mesh);

}  // namespace limn
