#pragma once

#include "ecs/reflect.h"
#include "ecs/row_mask.h"

#include <cstdint>
#include <vector>

namespace limn {

// What an archetype knows of its rows beside their values, a bit a row, for the few components that
// ask for it:
//
//     Storage::Toggle   which rows are disabled, and how many of each chunk. A tag, which has no
//                       column, keeps the versions of its bits here too.
//     tracks_rows       which rows were written since somebody last took them (TakeRows).
//
// Bits of rows beyond the last are clear for toggles and arbitrary for tracks, so that adding rows
// costs nothing but the marks. The archetype calls rows_came, row_moved and so on beside what it
// does to its columns, and only if it has such components at all.

/// The enable bits of one chunk.
struct ToggleChunk {
    RowMask disabled;
    std::uint32_t disabled_count;
    std::uint32_t version;  ///< of a tag: when a bit last changed
};

/// The enable bits of one component.
struct ToggleBits {
    ComponentId id = 0;
    int column = 0;            ///< of the archetype; negative for a tag
    std::uint32_t newest = 0;  ///< of a tag: no version of a chunk is newer
    std::vector<ToggleChunk> chunks;

    [[nodiscard]] bool is_enabled(std::uint32_t row) const {
        return !chunks[row / RowMask::kRows].disabled.test(row % RowMask::kRows);
    }
    /// Returns whether it was otherwise.
    bool set_enabled(std::uint32_t row, bool enabled) {
        ToggleChunk& chunk = chunks[row / RowMask::kRows];
        std::uint64_t& word = chunk.disabled.words[row % RowMask::kRows / RowMask::kWordRows];
        const std::uint64_t bit = std::uint64_t{1} << row % RowMask::kWordRows;
        if ((word >> row % RowMask::kWordRows & 1) != static_cast<std::uint64_t>(enabled)) {
            return false;
        }
        word ^= bit;
        chunk.disabled_count += enabled ? ~0u : 1u;
        return true;
    }
    [[nodiscard]] std::uint32_t disabled_count() const;
};

/// The rows of one column that were written since they were last taken.
struct TrackedRows {
    ComponentId id = 0;
    int column = 0;
    std::vector<RowMask> written;  ///< a chunk

    void mark(std::uint32_t row) { written[row / RowMask::kRows].set(row % RowMask::kRows); }
    /// For tasks that may mark rows of one chunk at the same time.
    void mark_shared(std::uint32_t row);
    void mark(std::uint32_t first, std::uint32_t count);
    /// The marked rows of the chunk below `rows`; none is marked afterwards.
    [[nodiscard]] RowMask take(std::uint32_t chunk, std::uint32_t rows);
};

class RowBits {
  public:
    void add_toggle(ComponentId id, int column) { toggles_.push_back({id, column, 0, {}}); }
    void add_track(ComponentId id, int column) { tracks_.push_back({id, column, {}}); }

    [[nodiscard]] bool empty() const { return toggles_.empty() && tracks_.empty(); }
    /// Ascending by component.
    [[nodiscard]] const std::vector<ToggleBits>& toggles() const { return toggles_; }
    [[nodiscard]] const std::vector<TrackedRows>& tracks() const { return tracks_; }
    /// nullptr: the archetype does not have the component, or it is of another kind.
    [[nodiscard]] ToggleBits* toggle(ComponentId id) {
        for (ToggleBits& toggle : toggles_) {
            if (toggle.id == id) {
                return &toggle;
            }
        }
        return nullptr;
    }
    [[nodiscard]] const ToggleBits* toggle(ComponentId id) const {
        return const_cast<RowBits*>(this)->toggle(id);
    }
    [[nodiscard]] TrackedRows* track(ComponentId id) {
        for (TrackedRows& track : tracks_) {
            if (track.id == id) {
                return &track;
            }
        }
        return nullptr;
    }
    /// Of the component in the column.
    [[nodiscard]] TrackedRows* track_of_column(int column) {
        for (TrackedRows& track : tracks_) {
            if (track.column == column) {
                return &track;
            }
        }
        return nullptr;
    }

    // ---- what happens to rows

    void add_chunk(std::uint32_t version);
    /// `count` rows from `first` on, enabled.
    void rows_came(std::uint32_t first, std::uint32_t count);
    /// `count` rows from `from` on took the place of those from `to` on, which are gone. The two
    /// may overlap if to < from.
    void rows_moved(std::uint32_t from, std::uint32_t to, std::uint32_t count);
    /// `count` rows from `first` on, the last of the archetype.
    void rows_went(std::uint32_t first, std::uint32_t count);
    /// Rows that came from another archetype keep the bits of the components that both have.
    void receive(const RowBits& source, std::uint32_t from, std::uint32_t to, std::uint32_t count);
    void forget_versions_before(std::uint32_t oldest);

    [[nodiscard]] std::size_t bytes() const;

  private:
    std::vector<ToggleBits> toggles_;
    std::vector<TrackedRows> tracks_;
};

}  // namespace limn
