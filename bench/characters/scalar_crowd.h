#pragma once

#include <cstddef>
#include <vector>

namespace limn::bench {

/// What a step of a crowd must at least do, as people write it by hand: a counting sort into cells
/// of 2 m, then over 3x3 cells the sum of d / |d|^2 of all within 2 m. `x`, `y`: `count` positions
/// in 0 .. side [m].
struct NeighborSums {
    std::vector<int> begins;
    std::vector<int> cells;
    std::vector<float> sorted_x;
    std::vector<float> sorted_y;
    std::vector<float> sums;  ///< x, y of each, in sorted order
};
void sum_neighbors_by_hand(
    const float* x, const float* y, std::size_t count, float side, NeighborSums& memory);

}  // namespace limn::bench
