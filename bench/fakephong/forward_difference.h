#pragma once

#include <array>
#include <cstddef>

namespace limn::fakephong {

// Polynomials at neighboring pixels by additions only: each pixel adds to the value the first
// difference, to the first difference the second, and so on; differences of the highest order are
// constant. After spec fakephong.forward-difference; T is anything that can be added and
// subtracted.
//
// Rounding errors of additions accumulate: a row should start from the table of the edge, not from
// the end of the row above.
// Techniques: fakephong.forward-difference

inline constexpr std::size_t kMaxDegree = 3;

/// Along a row: the current value and its differences of order 1 .. degree.
template <typename T>
struct RowDifferences {
    std::size_t degree = 0;
    std::array<T, kMaxDegree + 1> of_order = {};
};

/// Steps to the next pixel, by `degree` additions.
template <typename T>
void step(RowDifferences<T>& row) {
    for (std::size_t k = 0; k < row.degree; ++k) {
        row.of_order[k] = row.of_order[k] + row.of_order[k + 1];
    }
}

/// Around a pixel: rows[i] has the i-th differences downwards, along a row. Orders sum to `degree`
/// at most.
template <typename T>
struct PixelDifferences {
    std::size_t degree = 0;
    std::array<RowDifferences<T>, kMaxDegree + 1> rows = {};
};

/// The table of a polynomial of `degree` <= kMaxDegree, from its values f(x, y) at 3, 6 or 10
/// pixels, x to the right and y below.
template <typename T, typename Function>
[[nodiscard]] PixelDifferences<T> difference_table(std::size_t degree, Function f) {
    PixelDifferences<T> table = {.degree = degree};
    for (std::size_t i = 0; i <= degree; ++i) {
        table.rows[i].degree = degree - i;
        auto& row = table.rows[i].of_order;
        for (std::size_t j = 0; j <= degree - i; ++j) {
            row[j] = f(static_cast<int>(j), static_cast<int>(i));
        }
        for (std::size_t order = 1; order <= degree - i; ++order) {
            for (std::size_t j = degree - i; j >= order; --j) {
                row[j] = row[j] - row[j - 1];
            }
        }
    }
    for (std::size_t order = 1; order <= degree; ++order) {
        for (std::size_t i = degree; i >= order; --i) {
            for (std::size_t j = 0; j <= degree - i; ++j) {
                auto& here = table.rows[i].of_order[j];
                here = here - table.rows[i - 1].of_order[j];
            }
        }
    }
    return table;
}

/// Steps to a neighboring pixel, by 1, 3 or 6 additions.
template <typename T>
void step_right(PixelDifferences<T>& table) {
    for (RowDifferences<T>& row : table.rows) {
        step(row);
    }
}
template <typename T>
void step_left(PixelDifferences<T>& table) {
    for (RowDifferences<T>& row : table.rows) {
        for (std::size_t k = row.degree; k-- > 0;) {
            row.of_order[k] = row.of_order[k] - row.of_order[k + 1];
        }
    }
}
template <typename T>
void step_down(PixelDifferences<T>& table) {
    for (std::size_t i = 0; i < table.degree; ++i) {
        for (std::size_t j = 0; j < table.degree - i; ++j) {
            auto& here = table.rows[i].of_order[j];
            here = here + table.rows[i + 1].of_order[j];
        }
    }
}

}  // namespace limn::fakephong
