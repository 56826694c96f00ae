#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// The order in which a mesh's triangles are drawn. A GPU keeps the last vertices that it has
// transformed: a triangle that follows its neighbors uses them again (engine.opt-vertex; Hoppe
// 1999). 0.5 transformed vertices per triangle is the least of a large grid, 3 the most.

/// Vertices transformed per triangle, ACMR, with a first-in first-out cache of `entries` vertices.
/// Indices are below `vertices`; 0 without triangles.
[[nodiscard]] double transformed_per_triangle(
    std::span<const std::uint32_t> indices, std::size_t vertices, std::size_t entries = 16);

/// The same triangles, each with its corners in the same order, ordered for the cache by
/// meshoptimizer; as they are where that transforms no fewer vertices.
[[nodiscard]] std::vector<std::uint32_t>
order_for_cache(std::span<const std::uint32_t> indices, std::size_t vertices);

}  // namespace limn
