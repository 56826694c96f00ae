#pragma once

#include "ecs/components/surface.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace limn {

// Levels of detail of shadow casters: fewer triangles of the same vertices, with the distance by
// which their surface departs from the mesh. A shadow map draws the fewest triangles whose
// departure is below Shadow::detail texels.
//
// Edges are collapsed in order of their quadric error (Garland and Heckbert 1997); where that goes
// no further, or less well, vertices are merged by the cells of a grid (Rossignac and Borrel 1993);
// both by meshoptimizer. Only positions at rest count: parts of a skin that touch at rest may stay
// joined, which shows only where the map resolves what they touch with. Meshes with morph targets,
// whose lips and lids part, have collapsed edges only.

/// Most coarser levels of a mesh.
inline constexpr std::size_t kMaxCoarseLevels = 7;

struct CoarseTriangles {
    std::vector<std::uint32_t> indices;  ///< three per triangle
    float error = 0;  ///< largest distance of a vertex of the mesh, at rest, from these [m]
};

/// Coarser levels of a mesh with valid indices, each with at most 3/4 of the triangles of the one
/// before; none for a mesh that is small already, has positions that are not finite, or consists of
/// more than 200,000 triangles in pieces of fewer than 12.
[[nodiscard]] std::vector<CoarseTriangles> simplify_triangles(const MeshData& mesh);

/// Remembers the coarser levels of meshes, for worlds that are loaded again.
class CoarseMemory {
  public:
    /// simplify_triangles of each mesh that is not null, else nothing.
    [[nodiscard]] std::vector<std::vector<CoarseTriangles>>
    simplify(std::span<const MeshData* const> meshes);

  private:
    static constexpr std::size_t kMaxIndices = std::size_t{1} << 24;  // then it forgets all
    std::map<std::uint64_t, std::vector<CoarseTriangles>> levels_;    // by what they depend on
    std::size_t indices_ = 0;
};

}  // namespace limn
