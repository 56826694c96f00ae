#pragma once

#include "ecs/archetype.h"
#include "ecs/world_core.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// The part of a query that does not depend on types: which components it asks for, and the
// archetypes that have them. The list is kept and only extended, by the archetypes that are new
// since it was last looked at. It is in the order of their creation; of a query that reads shared
// components, archetypes with equal values follow each other, values in the order of their first
// use.

inline constexpr std::size_t kMaxQueryColumns = 16;

enum class TermKind : std::uint8_t {
    Read,           ///< const T
    Write,          ///< T
    OptionalRead,   ///< Optional<const T>
    OptionalWrite,  ///< Optional<T>
    With,           ///< With<T>
    Without,        ///< Without<T>
    Changed,        ///< Changed<T>: T must be there, its versions are compared
    TakeRows,       ///< TakeRows<T>: T must be there, the marks of its rows are taken
    AnyOf,          ///< AnyOf<T..>: one of those of its group must be there
};

struct QueryTerm {
    TermKind kind;
    ComponentId id;
    std::uint8_t group = 0;  ///< Changed and AnyOf terms of one group: any of them
    bool is_sparse = false;
    bool is_toggle = false;
};

/// Which rows of a chunk a query with toggled components visits.
enum class EnabledRows : std::uint8_t { None, Some, All };

struct QueryMatch {
    Archetype* archetype;
    std::array<std::int16_t, kMaxQueryColumns> columns;  ///< of each term with data, in order
};

namespace detail {

/// What Query::where asks for: numbers of shared values, all of which an archetype must have.
class SharedKeys {
  public:
    static constexpr std::size_t kMax = 4;
    void add(std::uint32_t key) {
        LIMN_CHECK_NOTE(count_ < kMax, "where: too many values in one query");
        keys_[count_++] = key;
    }
    [[nodiscard]] bool are_in(const Archetype& archetype) const;
    /// Those that have the first value; some may lack another.
    [[nodiscard]] std::span<const std::uint32_t> archetypes(const SharedValues& values) const {
        return keys_[0] != SharedValues::kUnknown ? values.archetypes(keys_[0])
                                                  : std::span<const std::uint32_t>();
    }

  private:
    std::array<std::uint32_t, kMax> keys_ = {};
    std::size_t count_ = 0;
};
struct NoKeys {};

}  // namespace detail

class QueryState {
  public:
    explicit QueryState(std::span<const QueryTerm> terms);

    /// Looks at the archetypes that are new. Not to be called by two threads at the same time.
    void update(const WorldCore& core) {
        if (seen_ != core.archetypes.size() || epoch_ != core.epoch) {
            extend(core);
        }
    }
    /// The same before an iteration, which is counted.
    void begin_call(const WorldCore& core) {
        // Not one step: threads that share a query of a const world may lose a count.
        const std::atomic_ref<std::uint64_t> count(calls_);
        count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        update(core);
    }
    /// How often the query has iterated or gathered, for statistics.
    [[nodiscard]] std::uint64_t calls() const { return calls_; }
    [[nodiscard]] std::span<const QueryMatch> matches() const { return matches_; }
    /// nullptr: the archetype does not match.
    [[nodiscard]] const QueryMatch* match_of(std::uint32_t archetype) const {
        const std::int32_t position = archetype < match_of_.size() ? match_of_[archetype] : -1;
        return position < 0 ? nullptr : &matches_[static_cast<std::size_t>(position)];
    }
    [[nodiscard]] std::span<const QueryTerm> terms() const { return terms_; }
    /// Whether the component is a term that is written, perhaps an Optional.
    [[nodiscard]] bool writes(ComponentId id) const;

    /// Whether every group of Changed terms has a change later than `since`; groups with a sparse
    /// component are left to row_changed. Of an archetype, false is certain and true may turn out
    /// to be no chunk.
    [[nodiscard]] bool archetype_changed(const Archetype& archetype, std::uint32_t since) const;
    [[nodiscard]] bool
    chunk_changed(const Archetype& archetype, std::uint32_t chunk, std::uint32_t since) const;
    [[nodiscard]] bool row_changed(
        const WorldCore& core, const Archetype& archetype, std::uint32_t row,
        std::uint32_t since) const;
    /// Whether the entity, of that archetype, has the required sparse components and none of the
    /// excluded.
    [[nodiscard]] bool
    row_matches(const WorldCore& core, const Archetype& archetype, Entity entity) const;
    /// Which rows of the chunk are enabled for the toggled terms: With and the like want the bit,
    /// Without does not. Fills `rows` if it is Some.
    [[nodiscard]] EnabledRows
    enabled_rows(const Archetype& archetype, std::uint32_t chunk, RowMask& rows) const;
    /// The same for one row.
    [[nodiscard]] bool row_enabled(const Archetype& archetype, std::uint32_t row) const;
    /// The set of the first required sparse component: the iteration follows its order. nullptr: it
    /// is empty.
    [[nodiscard]] const SparseSet* leading_set(const WorldCore& core) const;

  private:
    void extend(const WorldCore& core);
    [[nodiscard]] bool matches(const Archetype& archetype) const;
    [[nodiscard]] bool
    group_matches(const Archetype& archetype, std::uint8_t group, bool if_sparse) const;
    void sort_by_shared();
    std::vector<QueryTerm> terms_;
    std::vector<QueryMatch> matches_;
    std::vector<std::int32_t> match_of_;  ///< by archetype; -1: none
    std::size_t seen_ = 0;
    std::uint32_t epoch_ = 0;
    std::uint64_t calls_ = 0;
    bool reads_shared_ = false;               ///< some term with data is shared
    std::vector<std::uint8_t> table_groups_;  ///< groups of Changed terms without sparse components
    std::vector<std::uint8_t> sparse_groups_;  ///< those with
};

}  // namespace limn
