#include "bench/characters/scalar_crowd.h"

#include <algorithm>

namespace limn::bench {

void sum_neighbors_by_hand(
    const float* x, const float* y, std::size_t count, float side, NeighborSums& memory) {
    constexpr float kCell = 2.0f;
    const int columns = static_cast<int>(side / kCell) + 1;
    memory.begins.assign(static_cast<std::size_t>(columns) * columns + 1, 0);
    memory.cells.resize(count);
    memory.sorted_x.resize(count);
    memory.sorted_y.resize(count);
    memory.sums.resize(2 * count);
    int* const begins = memory.begins.data();
    for (std::size_t i = 0; i < count; ++i) {
        const int column = std::clamp(static_cast<int>(x[i] / kCell), 0, columns - 1);
        const int row = std::clamp(static_cast<int>(y[i] / kCell), 0, columns - 1);
        memory.cells[i] = row * columns + column;
        ++begins[memory.cells[i] + 1];
    }
    for (int c = 0; c < columns * columns; ++c) {
        begins[c + 1] += begins[c];
    }
    for (std::size_t i = count; i-- > 0;) {
        const int slot = --begins[memory.cells[i] + 1];
        memory.sorted_x[slot] = x[i];
        memory.sorted_y[slot] = y[i];
    }
    std::copy(begins + 1, begins + columns * columns + 1, begins);
    begins[columns * columns] = static_cast<int>(count);
    for (int row = 0; row < columns; ++row) {
        for (int column = 0; column < columns; ++column) {
            const int cell = row * columns + column;
            for (int i = begins[cell]; i < begins[cell + 1]; ++i) {
                float sum_x = 0;
                float sum_y = 0;
                for (int r = std::max(row - 1, 0); r <= std::min(row + 1, columns - 1); ++r) {
                    const int first = begins[r * columns + std::max(column - 1, 0)];
                    const int end = begins[r * columns + std::min(column + 1, columns - 1) + 1];
                    for (int j = first; j < end; ++j) {
                        const float dx = memory.sorted_x[i] - memory.sorted_x[j];
                        const float dy = memory.sorted_y[i] - memory.sorted_y[j];
                        const float d2 = dx * dx + dy * dy;
                        if (d2 < kCell * kCell && d2 > 0) {
                            sum_x += dx / d2;
                            sum_y += dy / d2;
                        }
                    }
                }
                memory.sums[2 * static_cast<std::size_t>(i)] = sum_x;
                memory.sums[2 * static_cast<std::size_t>(i) + 1] = sum_y;
            }
        }
    }
}

}  // namespace limn::bench
