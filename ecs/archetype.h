#pragma once

#include "ecs/column.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"
#include "ecs/row_bits.h"
#include "ecs/shared_values.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

// All entities with the same set of components, sparse ones apart, and with the same values of
// those of Storage::Shared, one row each. Every component has a column: an array over all rows, at
// least 64-byte aligned, without gaps, so that a system is a plain loop over arrays. The first rows
// live in a block shared by all columns; from some hundred rows on, at 1024 at the latest, each
// column has a VirtualRange of its own and never moves again. Rows up to the next multiple of 16
// can be read and written, so vector loops need no tail. A split component has a column, a lane,
// for each of its 4-byte scalars.
//
// 1024 rows are a chunk, the unit of work and of change versions. A version is the number of the
// system run (or the moment between runs) that last took the chunk of the column for writing; rows
// that come, go or move count as a change of all columns of their chunk, and are kept apart in one
// number a chunk.

inline constexpr std::uint32_t kChunkRows = 1024;
static_assert(kChunkRows == RowMask::kRows);
inline constexpr std::uint32_t kRowPadding = 16;
inline constexpr std::size_t kColumnAlign = 64;
#if defined(LIMN_SANITIZED)
inline constexpr std::uint32_t kMaxRows = 1u << 22;  // sanitizers have little address space
#else
inline constexpr std::uint32_t kMaxRows = 1u << 26;
#endif

/// A lane is a column that holds one scalar of a split component. The lanes of a component are
/// neighbors, in the order of its bytes. [bytes]
inline constexpr std::size_t kLaneBytes = 4;
/// What a lane holds, whatever its type is elsewhere.
using LaneScalar [[gnu::may_alias]] = std::uint32_t;

inline constexpr int kNoColumn = -1;
inline constexpr int kTagColumn = -2;     ///< present, but has no data
inline constexpr int kSharedColumn = -3;  ///< present, with one value for all rows

/// Whether `version` is later than `since`; numbers wrap around, so only the difference counts.
[[nodiscard]] constexpr bool is_newer(std::uint32_t version, std::uint32_t since) {
    return static_cast<std::int32_t>(version - since) > 0;
}

[[nodiscard]] constexpr std::uint32_t newer_of(std::uint32_t a, std::uint32_t b) {
    return is_newer(a, b) ? a : b;
}

/// Tasks of one system may write the same value to the same version at the same time.
inline void store_version(std::uint32_t& target, std::uint32_t version) {
    std::atomic_ref<std::uint32_t>(target).store(version, std::memory_order_relaxed);
}

[[nodiscard]] constexpr std::uint32_t chunks_of(std::uint32_t rows) {
    return (rows + kChunkRows - 1) / kChunkRows;
}

/// Neighboring rows.
struct RowRange {
    std::uint32_t first;
    std::uint32_t count;
};

/// Rows of one archetype of a world.
struct ArchetypeRows {
    std::uint32_t archetype;
    RowRange rows;
};

/// `count` neighboring rows that moved within an archetype.
struct RowMove {
    std::uint32_t from;
    std::uint32_t to;
    std::uint32_t count;
};

struct Column {
    std::byte* data = nullptr;
    const ComponentInfo* info = nullptr;
    std::uint32_t size = 0;               ///< of an element [bytes]; kLaneBytes in a lane
    std::uint32_t lane = 0;               ///< of a split component; lane 0 has the versions
    std::uint32_t newest = 0;             ///< no version of a chunk is newer
    std::vector<std::uint32_t> versions;  ///< last taken for writing, a chunk
    VirtualRange range;                   ///< empty while in a block

    [[nodiscard]] std::byte* at(std::uint32_t row) const { return data + std::size_t{row} * size; }
};

class Archetype;

/// How the row of an entity gets from one archetype to another.
struct RowPlan {
    struct Step {
        const Column* source;
        Column* target;            ///< nullptr: the other archetype has no such column
        std::uint32_t fixed_size;  ///< of an element that is moved by copying, else 0 [bytes]
    };
    Archetype* to = nullptr;
    std::vector<Step> steps;  ///< a column of the source each
};

class Archetype {
  public:
    /// `components` ascending, none of Storage::Sparse.
    /// `shared` has the values of those of Storage::Shared, in the same order.
    Archetype(
        std::uint32_t index, std::span<const ComponentId> components, BlockPool& blocks,
        std::span<const SharedValue> shared = {});
    Archetype(const Archetype&) = delete;
    Archetype& operator=(const Archetype&) = delete;
    ~Archetype();

    [[nodiscard]] std::uint32_t index() const { return index_; }
    [[nodiscard]] std::uint32_t size() const { return size_; }
    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    [[nodiscard]] std::uint32_t chunk_count() const { return chunks_of(size_); }
    [[nodiscard]] std::span<const Entity> entities() const { return {entities_, size_}; }
    /// Ascending, tags too.
    [[nodiscard]] std::span<const ComponentId> components() const { return components_; }
    /// The shared components and their values, ascending by component.
    [[nodiscard]] std::span<const SharedValue> shared() const { return shared_; }
    /// nullptr: it has no such shared component.
    [[nodiscard]] const SharedValue* shared_value(ComponentId id) const {
        for (const SharedValue& value : shared_) {
            if (value.component == id) {
                return &value;
            }
        }
        return nullptr;
    }
    [[nodiscard]] std::span<const Column> columns() const { return columns_; }
    [[nodiscard]] std::span<Column> columns() { return columns_; }
    [[nodiscard]] const Column& column(int index) const {
        return columns_[static_cast<std::size_t>(index)];
    }
    [[nodiscard]] Column& column(int index) { return columns_[static_cast<std::size_t>(index)]; }
    /// Where the component is: a column, kTagColumn, kSharedColumn or kNoColumn.
    [[nodiscard]] int column_of(ComponentId id) const {
        return id < column_of_.size() ? column_of_[id] : kNoColumn;
    }
    [[nodiscard]] bool has(ComponentId id) const { return column_of(id) != kNoColumn; }
    /// Whether columns have reserved ranges of their own.
    [[nodiscard]] bool is_promoted() const { return block_ == nullptr && capacity_ > 0; }
    [[nodiscard]] bool is_trivial() const { return is_trivial_; }
    /// Memory behind the columns and the entities [bytes].
    [[nodiscard]] std::size_t committed() const;

    // ---- rows; components are the caller's to construct and destroy
    // ------------------------------

    /// Adds a row whose components are raw memory.
    std::uint32_t append(Entity entity, std::uint32_t version) {
        if (size_ == capacity_) {
            grow(size_ + 1);
        }
        const std::uint32_t row = size_++;
        entities_[row] = entity;
        touch_structure(row, version);
        if (has_row_bits_) {
            bits_.rows_came(row, 1);
        }
        return row;
    }
    /// Adds a row for every entity; returns the first.
    std::uint32_t append(std::span<const Entity> entities, std::uint32_t version);
    void reserve(std::uint32_t rows) {
        if (rows > capacity_) {
            grow(rows);
        }
    }
    /// Gives back the memory that the rows do not need. Rows may move in memory.
    void shrink();
    /// Moves the last row into `row`, whose components are gone already, unless `row` is the last.
    void fill_hole(std::uint32_t row, std::uint32_t version);
    /// Moves a row to the end of another archetype, and the last row into the hole. Components that
    /// the other has more are raw memory, those it has less are gone. Returns the row there.
    std::uint32_t move_row(std::uint32_t row, const RowPlan& plan, std::uint32_t version);
    /// How rows get there; made once.
    [[nodiscard]] const RowPlan& plan_to(Archetype& to);
    void construct_default(std::uint32_t first, std::uint32_t count);
    void destroy_components(std::uint32_t first, std::uint32_t count) {
        if (!is_trivial_ && count > 0) {
            destroy_each(first, count);
        }
    }
    /// Destroys all rows; keeps the memory.
    void clear(std::uint32_t version);

    // ---- many rows at once (ecs/row_moves.cpp); `ranges` ascend and do not overlap
    // ---------------

    /// Appends the ranges of another archetype, in order; returns the first new row. Components
    /// that both have are moved, those only this one has are raw memory, those only `from` has are
    /// destroyed. What is left of the ranges is a gap.
    std::uint32_t
    append_from(Archetype& from, std::span<const RowRange> ranges, std::uint32_t version);
    /// The same for all rows of `from`, which is empty afterwards: instead of copies, the columns
    /// change hands. False, and nothing is done, if this archetype has rows or `from` so few that
    /// copies are as good.
    [[nodiscard]] bool take_over(Archetype& from, std::uint32_t version);
    /// Takes the columns of `from`, which has the same components and no rows, as its own, which
    /// has no rows either.
    void take_memory(Archetype& from);
    /// Takes rows out whose components are gone already. The gaps are filled, the lowest first,
    /// with the rows beyond the new end, the lowest first; these moves are put into `moves`.
    void
    close_gaps(std::span<const RowRange> gaps, std::uint32_t version, std::vector<RowMove>& moves);

    // ---- change versions
    // --------------------------------------------------------------------------

    /// Last change of rows of the chunk: came, went, moved.
    [[nodiscard]] std::uint32_t structure_version(std::uint32_t chunk) const {
        return structure_[chunk];
    }
    [[nodiscard]] std::uint32_t newest_structure() const { return newest_structure_; }
    /// Last change of the column in the chunk, of either kind.
    [[nodiscard]] std::uint32_t version(int column, std::uint32_t chunk) const {
        return column < 0 ? structure_[chunk]
                          : newer_of(
                              columns_[static_cast<std::size_t>(column)].versions[chunk],
                              structure_[chunk]);
    }
    /// The same of a component; the bits of a toggled tag, which has no column, count.
    [[nodiscard]] std::uint32_t version_of(ComponentId id, std::uint32_t chunk) const {
        const ToggleBits* tag = toggled_tag(id);
        return tag == nullptr ? version(column_of(id), chunk)
                              : newer_of(tag->chunks[chunk].version, structure_[chunk]);
    }
    [[nodiscard]] std::uint32_t newest_version_of(ComponentId id) const {
        const ToggleBits* tag = toggled_tag(id);
        return tag == nullptr ? newest_version(column_of(id))
                              : newer_of(tag->newest, newest_structure_);
    }
    /// No chunk of the column changed later.
    [[nodiscard]] std::uint32_t newest_version(int column) const {
        return column < 0
                   ? newest_structure_
                   : newer_of(columns_[static_cast<std::size_t>(column)].newest, newest_structure_);
    }
    /// Says that all rows are about to be written.
    void touch_column(int column, std::uint32_t version);
    /// Says that the row is about to be written.
    void touch_row(int column, std::uint32_t row, std::uint32_t version) {
        if (column >= 0) {
            Column& target = columns_[static_cast<std::size_t>(column)];
            store_version(target.versions[row / kChunkRows], version);
            store_version(target.newest, version);
        }
    }
    /// The same, and marks the row if the component tracks its rows. For code that does not know
    /// the type.
    void write_row(int column, std::uint32_t row, std::uint32_t version) {
        touch_row(column, row, version);
        if (has_row_bits_) {
            if (TrackedRows* track = bits_.track_of_column(column); track != nullptr) {
                track->mark(row);
            }
        }
    }
    void write_rows(int column, RowRange rows, std::uint32_t version);
    /// Makes versions that are older than `oldest` equal to it, so that differences never overflow.
    void forget_versions_before(std::uint32_t oldest);

    // ---- bits a row (ecs/row_bits.h)
    // --------------------------------------------------------------

    /// Whether there are bits at all: some component is toggled or tracks its rows.
    [[nodiscard]] bool has_row_bits() const { return has_row_bits_; }
    [[nodiscard]] RowBits& bits() { return bits_; }
    [[nodiscard]] const RowBits& bits() const { return bits_; }
    /// `toggle` is one of bits(). Returns whether it was otherwise; that is a change of the
    /// component.
    bool set_enabled(ToggleBits& toggle, std::uint32_t row, bool enabled, std::uint32_t version) {
        if (!toggle.set_enabled(row, enabled)) {
            return false;
        }
        touch_toggle(toggle, row, version);
        return true;
    }
    /// Says that the bit of the row has changed.
    void touch_toggle(ToggleBits& toggle, std::uint32_t row, std::uint32_t version) {
        if (toggle.column < 0) {
            toggle.chunks[row / kChunkRows].version = version;
            store_version(toggle.newest, version);
        } else if (has_tracked_toggles_) {
            write_row(toggle.column, row, version);
        } else {
            touch_row(toggle.column, row, version);
        }
    }
    /// The same by component; one that cannot be toggled stays enabled.
    void set_enabled(ComponentId id, std::uint32_t row, bool enabled, std::uint32_t version) {
        if (ToggleBits* toggle = bits_.toggle(id); toggle != nullptr) {
            set_enabled(*toggle, row, enabled, version);
        }
    }
    /// Whether the row has the component and it is not disabled.
    [[nodiscard]] bool is_enabled(ComponentId id, std::uint32_t row) const {
        const ToggleBits* toggle = bits_.toggle(id);
        return toggle != nullptr ? toggle->is_enabled(row) : has(id);
    }

    // ---- what the world remembers here
    // ------------------------------------------------------------

    std::vector<const RowPlan*> add_edges;     ///< to one component more, by id; null: unknown
    std::vector<const RowPlan*> remove_edges;  ///< to one component less
    bool observes_add = false;                 ///< some observer waits for a component of it
    bool observes_remove = false;
    std::uint64_t rows_moved_in = 0;  ///< from other archetypes, for the inspector
    std::uint64_t rows_moved_out = 0;

  private:
    void grow(std::uint32_t rows);
    void move_to_block(std::size_t bytes);
    void promote(std::uint32_t rows);
    void commit(std::uint32_t rows);
    void leave_block();
    void destroy_each(std::uint32_t first, std::uint32_t count);
    void bits_of_hole(std::uint32_t row, std::uint32_t last);
    [[nodiscard]] std::uint32_t rows_in_block(std::size_t bytes) const;
    void update_capacity();
    void add_chunk(std::uint32_t version);
    [[nodiscard]] const ToggleBits* toggled_tag(ComponentId id) const {
        const ToggleBits* toggle = has_row_bits_ ? bits_.toggle(id) : nullptr;
        return toggle != nullptr && toggle->column < 0 ? toggle : nullptr;
    }
    void touch_structure(RowRange rows, std::uint32_t version);
    void receive_bits(const Archetype& from, std::uint32_t row, std::span<const RowRange> ranges);
    void touch_structure(std::uint32_t row, std::uint32_t version) {
        const std::uint32_t chunk = row / kChunkRows;
        if (chunk >= structure_.size()) {
            add_chunk(version);
        }
        structure_[chunk] = version;
        newest_structure_ = version;
    }
    /// The same of a chunk that is there.
    void stamp_structure(std::uint32_t row, std::uint32_t version) {
        structure_[row / kChunkRows] = version;
        newest_structure_ = version;
    }

    std::uint32_t index_;
    std::uint32_t size_ = 0;
    std::uint32_t capacity_ = 0;
    std::uint32_t newest_structure_ = 0;
    Entity* entities_ = nullptr;
    std::vector<Column> columns_;
    std::vector<std::uint32_t> structure_;
    std::vector<std::int16_t> column_of_;
    std::vector<ComponentId> components_;
    std::vector<std::unique_ptr<RowPlan>> plans_;
    std::vector<SharedValue> shared_;
    VirtualRange entity_range_;
    BlockPool& blocks_;
    std::byte* block_ = nullptr;
    std::size_t block_bytes_ = 0;
    bool is_trivial_ = true;            ///< no destructors
    bool has_row_bits_ = false;         ///< bits_ is not empty
    bool has_tracked_toggles_ = false;  ///< some toggled component tracks its rows
    RowBits bits_;
};

/// Moves `count` values to raw memory and ends the sources.
void relocate_values(const ComponentInfo& info, void* destination, void* source, std::size_t count);
/// The same with elements of a column, which may be a lane.
void relocate_elements(const Column& column, void* destination, void* source, std::size_t count);

/// Copies rows of a split component, whose first lane is `lanes`, to values side by side.
void gather_values(const Column* lanes, std::uint32_t row, std::size_t count, void* values);
/// The way back; the lanes may be raw memory.
void scatter_values(Column* lanes, std::uint32_t row, std::size_t count, const void* values);
/// The same with one value for all rows.
void fill_values(Column* lanes, std::uint32_t row, std::size_t count, const void* value);

}  // namespace limn
