#pragma once

#include <cstdint>

namespace limn {

/// What sync points and bulk operations have done to a world so far.
struct FlushStats {
    std::uint64_t flushes = 0;          ///< with commands
    std::uint64_t commands = 0;         ///< applied; those for entities that were gone too
    std::uint64_t entities_folded = 0;  ///< had several commands
    std::uint64_t entities_created = 0;
    std::uint64_t entities_destroyed = 0;
    std::uint64_t rows_moved_singly = 0;  ///< without a neighbor
    std::uint64_t rows_moved_in_ranges = 0;
    std::uint64_t rows_handed_over = 0;  ///< moved by exchanging columns
    std::uint64_t archetypes_handed_over = 0;
};

}  // namespace limn
