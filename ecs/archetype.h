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

// All entities with the same set of components (not counting sparse ones) and the same values of
// Storage::Shared components, one row each. Every component has a column: a contiguous array over
// all rows, at least 64-byte aligned, so that a system is a plain loop over arrays. The first rows
// live in a block shared by all columns; from some hundred rows on, at 1024 at the latest, each
// column has its own VirtualRange and never moves again. Rows up to the next multiple of 16
// can be read and written, so vector loops need no tail. A split component has one column, a lane,
// for each of its 4-byte scalars.
//
// A chunk is 1024 rows, the unit of work and of change versions. A column has one version per
// chunk: the number of the system run (or of the time between runs) that last accessed it for
// writing. Added, removed or moved rows count as a change of all columns of their chunk, and are
// recorded separately in one structure version per chunk.

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
/// adjacent, in the order of its bytes. [bytes]
inline constexpr std::size_t kLaneBytes = 4;
/// Element type of a lane, whatever the type of the scalar.
using LaneScalar [[gnu::may_alias]] = std::uint32_t;

inline constexpr int kNoColumn = -1;
inline constexpr int kTagColumn = -2;     ///< present, without data
inline constexpr int kSharedColumn = -3;  ///< present, with one value for all rows

/// Whether `version` is later than `since`, modulo 2^32.
[[nodiscard]] constexpr bool is_newer(std::uint32_t version, std::uint32_t since) {
    return static_cast<std::int32_t>(version - since) > 0;
}

[[nodiscard]] constexpr std::uint32_t newer_of(std::uint32_t a, std::uint32_t b) {
    return is_newer(a, b) ? a : b;
}

/// Atomic: tasks of one system may store the same version concurrently.
inline void store_version(std::uint32_t& target, std::uint32_t version) {
    std::atomic_ref<std::uint32_t>(target).store(version, std::memory_order_relaxed);
}

[[nodiscard]] constexpr std::uint32_t chunks_of(std::uint32_t rows) {
    return (rows + kChunkRows - 1) / kChunkRows;
}

/// Consecutive rows.
struct RowRange {
    std::uint32_t first;
    std::uint32_t count;
};

/// Rows of one archetype of a world.
struct ArchetypeRows {
    std::uint32_t archetype;
    RowRange rows;
};

/// `count` consecutive rows that moved within an archetype.
struct RowMove {
    std::uint32_t from;
    std::uint32_t to;
    std::uint32_t count;
};

struct Column {
    std::byte* data = nullptr;
    const ComponentInfo* info = nullptr;
    std::uint32_t size = 0;               ///< of one element [bytes]; kLaneBytes for a lane
    std::uint32_t lane = 0;               ///< index in a split component; lane 0 has the versions
    std::uint32_t newest = 0;             ///< upper bound of `versions`
    std::vector<std::uint32_t> versions;  ///< last write access, per chunk
    VirtualRange range;                   ///< empty while the column is in a block

    [[nodiscard]] std::byte* at(std::uint32_t row) const { return data + std::size_t{row} * size; }
};

class Archetype;

/// How to move the row of an entity from one archetype to another.
struct RowPlan {
    struct Step {
        const Column* source;
        Column* target;            ///< nullptr: the target archetype has no such column
        std::uint32_t fixed_size;  ///< element size if it can be moved by memcpy, else 0 [bytes]
    };
    Archetype* to = nullptr;
    std::vector<Step> steps;  ///< one per column of the source
};

class Archetype {
  public:
    /// `components` must be ascending, without Storage::Sparse. `shared` has the values of the
    /// Storage::Shared components, in the same order.
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
    /// Ascending, including tags.
    [[nodiscard]] std::span<const ComponentId> components() const { return components_; }
    /// The shared components and their values, ascending by component.
    [[nodiscard]] std::span<const SharedValue> shared() const { return shared_; }
    /// nullptr if it has no such shared component.
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
    /// The component's column index, or kTagColumn, kSharedColumn or kNoColumn.
    [[nodiscard]] int column_of(ComponentId id) const {
        return id < column_of_.size() ? column_of_[id] : kNoColumn;
    }
    [[nodiscard]] bool has(ComponentId id) const { return column_of(id) != kNoColumn; }
    /// Whether each column has its own reserved range.
    [[nodiscard]] bool is_promoted() const { return block_ == nullptr && capacity_ > 0; }
    [[nodiscard]] bool is_trivial() const { return is_trivial_; }
    /// Memory behind the columns and the entities [bytes].
    [[nodiscard]] std::size_t committed() const;

    // ---- rows; the caller constructs and destroys components
    // -------------------------------------

    /// Adds a row whose components are raw memory.
    std::uint32_t append(Entity entity, std::uint32_t version) {
        if (size_ == capacity_) {
            grow(size_ + 1);
        }
        const std::uint32_t row = size_++;
        entities_[row] = entity;
        touch_structure(row, version);
        if (has_row_bits_) {
            bits_.rows_added(row, 1);
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
    /// Releases unused memory. Rows may move in memory.
    void shrink();
    /// Removes `row`, whose components are already destroyed, by moving the last row into it.
    void fill_hole(std::uint32_t row, std::uint32_t version);
    /// Moves a row to the end of another archetype, and the last row into the hole. Components that
    /// only the target has are raw memory, those it lacks are destroyed. Returns the new row.
    std::uint32_t move_row(std::uint32_t row, const RowPlan& plan, std::uint32_t version);
    /// The cached plan for moving rows to `to`.
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
    /// destroyed. The ranges remain in `from` as gaps.
    std::uint32_t
    append_from(Archetype& from, std::span<const RowRange> ranges, std::uint32_t version);
    /// The same for all rows of `from`, which is empty afterwards, by exchanging whole columns
    /// instead of copying. Returns false, and does nothing, if this archetype has rows or if `from`
    /// has so few that copying is as fast.
    [[nodiscard]] bool adopt_rows(Archetype& from, std::uint32_t version);
    /// Takes the column memory of `from`, which has the same components; both must have no rows.
    void take_memory(Archetype& from);
    /// Removes rows whose components are already destroyed. Fills the gaps in ascending order with
    /// the rows beyond the new end, also in ascending order; appends these moves to `moves`.
    void
    close_gaps(std::span<const RowRange> gaps, std::uint32_t version, std::vector<RowMove>& moves);

    // ---- change versions
    // --------------------------------------------------------------------------

    /// When rows of the chunk were last added, removed or moved.
    [[nodiscard]] std::uint32_t structure_version(std::uint32_t chunk) const {
        return structure_[chunk];
    }
    [[nodiscard]] std::uint32_t newest_structure() const { return newest_structure_; }
    /// Last change of the column in the chunk, by writing or of structure.
    [[nodiscard]] std::uint32_t version(int column, std::uint32_t chunk) const {
        return column < 0 ? structure_[chunk]
                          : newer_of(
                              columns_[static_cast<std::size_t>(column)].versions[chunk],
                              structure_[chunk]);
    }
    /// The same by component; for a toggled tag, which has no column, its enable bits count.
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
    /// Upper bound of version() over all chunks of the column.
    [[nodiscard]] std::uint32_t newest_version(int column) const {
        return column < 0
                   ? newest_structure_
                   : newer_of(columns_[static_cast<std::size_t>(column)].newest, newest_structure_);
    }
    /// Marks all rows as about to be written.
    void touch_column(int column, std::uint32_t version);
    /// Marks the row as about to be written.
    void touch_row(int column, std::uint32_t row, std::uint32_t version) {
        if (column >= 0) {
            Column& target = columns_[static_cast<std::size_t>(column)];
            store_version(target.versions[row / kChunkRows], version);
            store_version(target.newest, version);
        }
    }
    /// The same, and sets the row's mark if the component tracks rows. For type-erased code.
    void write_row(int column, std::uint32_t row, std::uint32_t version) {
        touch_row(column, row, version);
        if (has_row_bits_) {
            if (TrackedRows* track = bits_.track_of_column(column); track != nullptr) {
                track->mark(row);
            }
        }
    }
    void write_rows(int column, RowRange rows, std::uint32_t version);
    /// Clamps versions to be no older than `oldest`, so that differences never overflow.
    void clamp_versions(std::uint32_t oldest);

    // ---- bits per row (ecs/row_bits.h)
    // ------------------------------------------------------------

    /// Whether any component is toggled or tracks its rows.
    [[nodiscard]] bool has_row_bits() const { return has_row_bits_; }
    [[nodiscard]] RowBits& bits() { return bits_; }
    [[nodiscard]] const RowBits& bits() const { return bits_; }
    /// `toggle` is one of bits(). Returns whether the bit changed, which counts as a change of the
    /// component.
    bool set_enabled(ToggleBits& toggle, std::uint32_t row, bool enabled, std::uint32_t version) {
        if (!toggle.set_enabled(row, enabled)) {
            return false;
        }
        touch_toggle(toggle, row, version);
        return true;
    }
    /// Records that the enable bit of the row has changed.
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
    /// Sets the enable bit by component; does nothing for one that cannot be toggled.
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

    // ---- data of the world
    // ------------------------------------------------------------------------

    std::vector<const RowPlan*> add_edges;     ///< for adding a component, by id; null: unknown
    std::vector<const RowPlan*> remove_edges;  ///< for removing a component
    bool observes_add = false;                 ///< some observer is registered for a component
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
    /// The same for a chunk that already exists.
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

/// Moves `count` values to raw memory and destroys the sources.
void relocate_values(const ComponentInfo& info, void* destination, void* source, std::size_t count);
/// The same with elements of a column, which may be a lane.
void relocate_elements(const Column& column, void* destination, void* source, std::size_t count);

/// Copies rows of a split component, whose first lane is `lanes`, to an array of structs.
void gather_values(const Column* lanes, std::uint32_t row, std::size_t count, void* values);
/// The inverse of gather_values(); the lanes may be raw memory.
void scatter_values(Column* lanes, std::uint32_t row, std::size_t count, const void* values);
/// Scatters one value to all rows.
void fill_values(Column* lanes, std::uint32_t row, std::size_t count, const void* value);

}  // namespace limn
