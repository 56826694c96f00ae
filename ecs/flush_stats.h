#pragma once

#include <cstdint>

namespace limn {

/// Totals of a world's sync points and bulk operations so far.
struct FlushStats {
    std::uint64_t flushes = 0;          ///< sync points with commands
    std::uint64_t commands = 0;         ///< applied, or dropped because the entity was gone
    std::uint64_t entities_folded = 0;  ///< with several commands folded into one change
    std::uint64_t entities_created = 0;
    std::uint64_t entities_destroyed = 0;
    std::uint64_t rows_moved_singly = 0;  ///< one at a time
    std::uint64_t rows_moved_in_ranges = 0;
    std::uint64_t rows_handed_over = 0;  ///< moved by exchanging columns
    std::uint64_t archetypes_handed_over = 0;
};

}  // namespace limn
