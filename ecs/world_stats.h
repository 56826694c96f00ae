#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limn {

class World;

// Figures about a world, for the inspector, `limn info` and tests.

/// Memory that a world holds [bytes]. What components own themselves (strings, vectors) is not in
/// it.
struct WorldMemory {
    std::size_t slots = 0;       ///< handles
    std::size_t archetypes = 0;  ///< columns and entities of promoted archetypes
    std::size_t blocks = 0;      ///< the pool of the small ones, free blocks too
    std::size_t sparse = 0;
    std::size_t versions = 0;  ///< of chunks, and bits of rows
    std::size_t used = 0;      ///< the part of archetypes and blocks that rows fill
    [[nodiscard]] std::size_t total() const {
        return slots + archetypes + blocks + sparse + versions;
    }
};

struct ArchetypeStats {
    std::vector<std::string> components;
    std::uint32_t rows = 0;
    std::uint32_t capacity = 0;  ///< rows without asking for memory
    std::uint32_t chunks = 0;
    std::uint32_t row_bytes = 0;      ///< with the handle [bytes]
    std::size_t committed = 0;        ///< [bytes]
    bool promoted = false;            ///< columns in address ranges of their own
    std::uint64_t rows_moved_in = 0;  ///< from other archetypes, since the beginning
    /// Of the components that have disabled rows: which, and how many.
    std::vector<std::pair<std::string, std::uint32_t>> disabled;
    /// Share of the committed memory that rows fill, 0 .. 1.
    [[nodiscard]] double fill() const {
        return committed > 0
                   ? static_cast<double>(rows) * row_bytes / static_cast<double>(committed)
                   : 0.0;
    }
};

struct SparseStats {
    std::string component;
    std::uint32_t values = 0;
    std::size_t committed = 0;  ///< [bytes]
};

struct WorldStats {
    std::size_t entities = 0;
    std::size_t free_slots = 0;
    std::vector<ArchetypeStats> archetypes;  ///< in the order of queries
    std::vector<SparseStats> sparse_sets;
    WorldMemory memory;
};

[[nodiscard]] WorldStats world_stats(const World& world);

/// One line an archetype and a sparse set, then the memory.
[[nodiscard]] std::string to_text(const WorldStats& stats);

}  // namespace limn
