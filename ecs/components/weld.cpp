#include "ecs/components/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <numeric>

namespace limn {

namespace {

/// Equal for equal positions, ordered for all, NaN included.
std::array<std::uint32_t, 3> key_of(const Vec3& position) {
    const Vec3 p = position + 0.0f;  // -0 becomes 0
    return {
        std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
        std::bit_cast<std::uint32_t>(p.z)};
}

}  // namespace

std::vector<std::uint32_t> weld_positions(std::span<const Vec3> positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(
        order, {}, [&](std::uint32_t vertex) { return key_of(positions[vertex]); });
    std::vector<std::uint32_t> welded(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool repeated =
            i > 0 && key_of(positions[order[i]]) == key_of(positions[order[i - 1]]);
        welded[order[i]] = repeated ? welded[order[i - 1]] : order[i];
    }
    return welded;
}

}  // namespace limn
