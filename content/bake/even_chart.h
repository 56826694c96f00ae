#pragma once

#include "ecs/components/surface.h"

#include <span>
#include <vector>

namespace limn {

// Texture coordinates for patterns of one size all over a surface, as pores, which those of the
// mesh would stretch. They keep the mesh's seams, and their axes nearly follow its axes.
// After Liu, Zhang, Xu, Gotsman and Gortler, "A Local/Global Approach to Mesh Parameterization",
// 2008: triangles as rigid as possible. A surface that is no cylinder or cone keeps some stretch.

/// One per vertex, in units of `size` > 0, which is in that of the positions; the search begins at
/// the `uvs` of `mesh`. `importance` per vertex, > 0: what counts more is stretched less, at the
/// cost of the rest. Triangles without an area count for nothing.
[[nodiscard]] std::vector<Vec2>
make_even_chart(const MeshData& mesh, float size, std::span<const float> importance);

}  // namespace limn
