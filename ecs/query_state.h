#pragma once

#include "ecs/archetype.h"
#include "ecs/world_core.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// The type-erased part of a query: its terms and the cached list of matching archetypes, to which
// new archetypes are added incrementally. The list is in creation order; if the query reads shared
// components, archetypes with equal values are adjacent, values in the order of first use.

inline constexpr std::size_t kMaxQueryColumns = 16;

enum class TermKind : std::uint8_t {
    Read,           ///< const T
    Write,          ///< T
    OptionalRead,   ///< Optional<const T>
    OptionalWrite,  ///< Optional<T>
    With,           ///< With<T>
    Without,        ///< Without<T>
    Changed,        ///< Changed<T>: requires T and compares its versions
    TakeRows,       ///< TakeRows<T>: requires T and fetches the marks of its rows
    AnyOf,          ///< AnyOf<T..>: requires one component of its group
};

struct QueryTerm {
    TermKind kind;
    ComponentId id;
    std::uint8_t group = 0;  ///< Changed and AnyOf terms with equal group are alternatives
    bool is_sparse = false;
    bool is_toggle = false;
};

/// Which rows of a chunk a query with toggled components visits.
enum class EnabledRows : std::uint8_t { None, Some, All };

struct QueryMatch {
    Archetype* archetype;
    std::array<std::int16_t, kMaxQueryColumns> columns;  ///< per term with data, in order
};

namespace detail {

/// The filter of Query::where: keys of shared values, all of which an archetype must have.
class SharedKeys {
  public:
    static constexpr std::size_t kMax = 4;
    void add(std::uint32_t key) {
        LIMN_CHECK_NOTE(count_ < kMax, "where: too many values in one query");
        keys_[count_++] = key;
    }
    [[nodiscard]] bool are_in(const Archetype& archetype) const;
    /// The archetypes that have the first value; some may lack another.
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

    /// Adds new archetypes. Not thread-safe.
    void update(const WorldCore& core) {
        if (seen_ != core.archetypes.size() || epoch_ != core.epoch) {
            extend(core);
        }
    }
    /// update() before an iteration, which is counted.
    void begin_call(const WorldCore& core) {
        // Not an atomic increment: threads that share a query of a const world may lose a count.
        const std::atomic_ref<std::uint64_t> count(calls_);
        count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        update(core);
    }
    /// How often the query has iterated or gathered, for statistics.
    [[nodiscard]] std::uint64_t calls() const { return calls_; }
    [[nodiscard]] std::span<const QueryMatch> matches() const { return matches_; }
    /// nullptr if the archetype does not match.
    [[nodiscard]] const QueryMatch* match_of(std::uint32_t archetype) const {
        const std::int32_t position = archetype < match_of_.size() ? match_of_[archetype] : -1;
        return position < 0 ? nullptr : &matches_[static_cast<std::size_t>(position)];
    }
    [[nodiscard]] std::span<const QueryTerm> terms() const { return terms_; }
    /// Whether the component is a written term, possibly Optional.
    [[nodiscard]] bool writes(ComponentId id) const;

    /// Whether every group of Changed terms has a change later than `since`; groups with a sparse
    /// component are left to row_changed. For an archetype this is conservative: true does not
    /// guarantee that any chunk changed.
    [[nodiscard]] bool archetype_changed(const Archetype& archetype, std::uint32_t since) const;
    [[nodiscard]] bool
    chunk_changed(const Archetype& archetype, std::uint32_t chunk, std::uint32_t since) const;
    [[nodiscard]] bool row_changed(
        const WorldCore& core, const Archetype& archetype, std::uint32_t row,
        std::uint32_t since) const;
    /// Whether the entity, of that archetype, has all required sparse components and none of the
    /// excluded ones.
    [[nodiscard]] bool
    row_matches(const WorldCore& core, const Archetype& archetype, Entity entity) const;
    /// Which rows of the chunk pass the toggled terms: With and the like require enabled rows,
    /// Without excludes them. Fills `rows` if the result is Some.
    [[nodiscard]] EnabledRows
    enabled_rows(const Archetype& archetype, std::uint32_t chunk, RowMask& rows) const;
    /// The same for one row.
    [[nodiscard]] bool row_enabled(const Archetype& archetype, std::uint32_t row) const;
    /// The set of the first required sparse component, whose order the iteration follows. nullptr
    /// if it was never used.
    [[nodiscard]] const SparseSet* leading_set(const WorldCore& core) const;

  private:
    void extend(const WorldCore& core);
    [[nodiscard]] bool matches(const Archetype& archetype) const;
    [[nodiscard]] bool
    group_matches(const Archetype& archetype, std::uint8_t group, bool if_sparse) const;
    void sort_by_shared();
    std::vector<QueryTerm> terms_;
    std::vector<QueryMatch> matches_;
    std::vector<std::int32_t> match_of_;  ///< index in matches_ by archetype; -1: none
    std::size_t seen_ = 0;
    std::uint32_t epoch_ = 0;
    std::uint64_t calls_ = 0;
    bool reads_shared_ = false;               ///< some term with data is shared
    std::vector<std::uint8_t> table_groups_;  ///< groups of Changed terms without sparse components
    std::vector<std::uint8_t> sparse_groups_;  ///< groups with sparse components
};

}  // namespace limn
