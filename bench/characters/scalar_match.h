#pragma once

#include <cstddef>

namespace limn::bench {

// The search of motion matching as people write it by hand: what `limn bench characters` compares
// with.

/// Index of the row nearest to the query, of `count` > 0 rows of `width` numbers.
[[nodiscard]] std::size_t
nearest_by_hand(const float* rows, std::size_t count, std::size_t width, const float* query);

}  // namespace limn::bench
