#pragma once

#include "ecs/flush_stats.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limn {

class QueryState;
class Schedule;
class World;

// Figures about a world and the systems that run over it, for the inspector
// and tests; as text for people and as JSON for programs. What they cost while nobody looks is one
// addition a call of a query, a move of a row and a command.

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
    std::vector<std::string> kinds;  ///< of the components: "" of a table, "split", "id=3" ...
    std::uint32_t rows = 0;
    std::uint32_t capacity = 0;  ///< rows without asking for memory
    std::uint32_t chunks = 0;
    std::uint32_t row_bytes = 0;       ///< with the handle [bytes]
    std::size_t committed = 0;         ///< [bytes]
    bool promoted = false;             ///< columns in address ranges of their own
    std::uint64_t rows_moved_in = 0;   ///< from other archetypes, since the beginning
    std::uint64_t rows_moved_out = 0;  ///< to other archetypes
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

/// What a query visits. Sparse, toggled and Changed terms leave some of the rows out.
struct QueryStats {
    std::string terms;  ///< "const transform, spin, Without<frozen>"
    std::size_t archetypes = 0;
    std::size_t chunks = 0;
    std::size_t rows = 0;
    std::uint64_t calls = 0;  ///< iterations since the beginning
};

struct WorldStats {
    std::size_t entities = 0;
    std::size_t free_slots = 0;
    std::vector<ArchetypeStats> archetypes;  ///< in the order of queries
    std::vector<SparseStats> sparse_sets;
    std::vector<QueryStats> queries;  ///< of world.query() and of systems that world.run() ran
    FlushStats flush;
    WorldMemory memory;
};

/// A system of a schedule.
struct SystemStats {
    std::string name;
    double last = 0.0;  ///< without the commands it recorded [s]
    double mean = 0.0;  ///< [s]
    std::uint64_t runs = 0;
    std::uint64_t commands = 0;       ///< recorded in all runs
    std::uint64_t last_commands = 0;  ///< in the last run with any
    std::vector<QueryStats> queries;  ///< those of its parameters
};

/// A point where the commands of the systems before it are applied.
struct SyncStats {
    std::string after;  ///< the system before it
    double last = 0.0;  ///< of the last run with commands [s]
    double mean = 0.0;  ///< [s]
    std::uint64_t runs = 0;
    std::uint64_t commands = 0;
};

struct ScheduleStats {
    std::vector<SystemStats> systems;  ///< in their order
    std::vector<SyncStats> syncs;
};

[[nodiscard]] WorldStats world_stats(const World& world);

[[nodiscard]] ScheduleStats schedule_stats(const Schedule& schedule);
[[nodiscard]] QueryStats query_stats(const QueryState& query);

/// A line each: archetypes, sparse sets, queries that were called, what sync points did, memory.
[[nodiscard]] std::string to_text(const WorldStats& stats);
/// A line a system, with one for each of its queries below it, and a line a sync point.
[[nodiscard]] std::string to_text(const ScheduleStats& stats);

/// One object; times in seconds, memory in bytes.
[[nodiscard]] std::string to_json(const WorldStats& stats);
[[nodiscard]] std::string to_json(const ScheduleStats& stats);

}  // namespace limn
