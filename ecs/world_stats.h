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

// Statistics of a world and its systems, for the inspector and tests; as text for people and as
// JSON for programs. While unused they cost one addition per call of a query, row move and command.

/// Memory of a world [bytes], without memory owned by components (strings, vectors).
struct WorldMemory {
    std::size_t slots = 0;       ///< handles
    std::size_t archetypes = 0;  ///< columns and entities of promoted archetypes
    std::size_t blocks = 0;      ///< block pool of small archetypes, including free blocks
    std::size_t sparse = 0;
    std::size_t versions = 0;  ///< chunk versions and row bits
    std::size_t used = 0;      ///< part of archetypes and blocks that is filled by rows
    [[nodiscard]] std::size_t total() const {
        return slots + archetypes + blocks + sparse + versions;
    }
};

struct ArchetypeStats {
    std::vector<std::string> components;
    std::vector<std::string> kinds;  ///< per component: "" for a table, "split", "id=3" ...
    std::uint32_t rows = 0;
    std::uint32_t capacity = 0;  ///< rows that fit without allocating
    std::uint32_t chunks = 0;
    std::uint32_t row_bytes = 0;       ///< including the handle [bytes]
    std::size_t committed = 0;         ///< [bytes]
    bool promoted = false;             ///< each column has its own address range
    std::uint64_t rows_moved_in = 0;   ///< from other archetypes, in total
    std::uint64_t rows_moved_out = 0;  ///< to other archetypes, in total
    /// Components with disabled rows, and the number of these rows.
    std::vector<std::pair<std::string, std::uint32_t>> disabled;
    /// Fraction of the committed memory that is filled by rows, 0 .. 1.
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

/// What a query visits. Sparse, toggled and Changed terms skip some of the rows.
struct QueryStats {
    std::string terms;  ///< "const transform, spin, Without<frozen>"
    std::size_t archetypes = 0;
    std::size_t chunks = 0;
    std::size_t rows = 0;
    std::uint64_t calls = 0;  ///< iterations in total
};

struct WorldStats {
    std::size_t entities = 0;
    std::size_t free_slots = 0;
    std::vector<ArchetypeStats> archetypes;  ///< in the order of queries
    std::vector<SparseStats> sparse_sets;
    std::vector<QueryStats> queries;  ///< of world.query() and of systems run by world.run()
    FlushStats flush;
    WorldMemory memory;
};

/// A system of a schedule.
struct SystemStats {
    std::string name;
    double last = 0.0;  ///< excluding the commands it recorded [s]
    double mean = 0.0;  ///< [s]
    std::uint64_t runs = 0;
    std::uint64_t commands = 0;       ///< recorded in all runs
    std::uint64_t last_commands = 0;  ///< recorded in the last run that recorded any
    std::vector<QueryStats> queries;  ///< its query parameters
};

/// A sync point, where commands of the preceding systems are applied.
struct SyncStats {
    std::string after;  ///< the preceding system
    double last = 0.0;  ///< of the last run with commands [s]
    double mean = 0.0;  ///< [s]
    std::uint64_t runs = 0;
    std::uint64_t commands = 0;
};

struct ScheduleStats {
    std::vector<SystemStats> systems;  ///< in list order
    std::vector<SyncStats> syncs;
};

[[nodiscard]] WorldStats world_stats(const World& world);

[[nodiscard]] ScheduleStats schedule_stats(const Schedule& schedule);
[[nodiscard]] QueryStats query_stats(const QueryState& query);

/// One line each for archetypes, sparse sets, queries with calls, sync points and memory.
[[nodiscard]] std::string to_text(const WorldStats& stats);
/// One line per system, followed by one per query of it, and one line per sync point.
[[nodiscard]] std::string to_text(const ScheduleStats& stats);

/// One object; times in seconds, memory in bytes.
[[nodiscard]] std::string to_json(const WorldStats& stats);
[[nodiscard]] std::string to_json(const ScheduleStats& stats);

}  // namespace limn
