#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Texture coordinates for patterns of one size all over a surface, as pores, which those of the
// mesh would stretch. They keep the mesh's seams, and their axes nearly follow its axes.
// After Liu, Zhang, Xu, Gotsman and Gortler, "A Local/Global Approach to Mesh Parameterization",
// 2008: triangles as rigid as possible. A surface that is no cylinder or cone keeps some stretch.

/// Two vertices at one place of the surface, on both sides of a seam, that lie `step` apart in the
/// chart: if by whole repeats of a pattern, it goes on across the seam.
struct ChartJoin {
    std::uint32_t from = 0;  ///< not the `to` of another join
    std::uint32_t to = 0;    ///< of one join only
    Vec2 step = {0, 0};
};

/// One per vertex, in units of `size` > 0, which is in that of the positions; the search begins at
/// the `uvs` of `mesh`. `importance` per vertex, > 0: what counts more is stretched less, at the
/// cost of the rest. Triangles without an area count for nothing.
[[nodiscard]] std::vector<Vec2> make_even_chart(
    const MeshData& mesh, float size, std::span<const float> importance,
    std::span<const ChartJoin> joins = {});

}  // namespace limn
