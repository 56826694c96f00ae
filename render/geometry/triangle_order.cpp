#include "render/geometry/triangle_order.h"

#include <meshoptimizer.h>

#include <algorithm>

// Techniques: engine.opt-vertex

namespace limn {

double transformed_per_triangle(
    std::span<const std::uint32_t> indices, std::size_t vertices, std::size_t entries) {
    if (indices.size() < 3) {
        return 0;
    }
    // When each vertex entered: it is in the cache until `entries` others have.
    std::vector<std::size_t> entered(vertices, 0);
    std::size_t transformed = 0;
    for (const std::uint32_t index : indices) {
        if (entered[index] == 0 || transformed - entered[index] >= entries) {
            entered[index] = ++transformed;
        }
    }
    return static_cast<double>(transformed) / static_cast<double>(indices.size() / 3);
}

std::vector<std::uint32_t>
order_for_cache(std::span<const std::uint32_t> indices, std::size_t vertices) {
    std::vector<std::uint32_t> ordered(indices.begin(), indices.end());
    if (indices.empty()) {
        return ordered;
    }
    meshopt_optimizeVertexCache(ordered.data(), indices.data(), indices.size(), vertices);
    if (transformed_per_triangle(ordered, vertices)
        >= transformed_per_triangle(indices, vertices)) {
        std::ranges::copy(indices, ordered.begin());
    }
    return ordered;
}

}  // namespace limn
