#pragma once

#include "ecs/base/jobs.h"

#include <algorithm>
#include <cstddef>
#include <functional>

namespace limn {

/// Called by the baking thread with the number of rows that are finished.
using RowProgress = std::function<void(int rows)>;

/// Calls body(y) for each row of a map, on all threads.
template <typename Body>
void bake_rows(int rows, const RowProgress& progress, Body&& body) {
    constexpr int kBand = 32;
    for (int first = 0; first < rows; first += kBand) {
        const int count = std::min(kBand, rows - first);
        parallel_for(static_cast<std::size_t>(count), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                body(first + static_cast<int>(i));
            }
        });
        if (progress) {
            progress(first + count);
        }
    }
}

}  // namespace limn
