#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Texture coordinates for patterns of uniform size all over a surface, such as pores, which those
// of the mesh would stretch. They keep the mesh's seams and nearly keep the directions of its axes.
// After Liu, Zhang, Xu, Gotsman and Gortler, "A Local/Global Approach to Mesh Parameterization",
// 2008: triangles as rigid as possible. A surface that is not developable keeps some stretch.

/// Two vertices at one position, on both sides of a seam, that are `step` apart in the chart: if by
/// whole repeats of a pattern, it continues across the seam.
struct ChartJoin {
    std::uint32_t from = 0;  ///< must not be the `to` of another join
    std::uint32_t to = 0;    ///< unique among joins
    Vec2 step = {0, 0};
};

/// One per vertex, in units of `size` > 0, which is in the unit of the positions; iteration starts
/// from the `uvs` of `mesh`. `importance` per vertex, > 0: the more important is stretched less, at
/// the cost of the rest. Triangles without an area are ignored.
[[nodiscard]] std::vector<Vec2> make_even_chart(
    const MeshData& mesh, float size, std::span<const float> importance,
    std::span<const ChartJoin> joins = {});

}  // namespace limn
