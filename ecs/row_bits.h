#pragma once

#include "ecs/reflect.h"
#include "ecs/row_mask.h"

#include <cstdint>
#include <vector>

namespace limn {

// One bit per row of an archetype, for the components that need it:
//
//     Storage::Toggle   which rows are disabled, and how many in each chunk. For a tag, which has
//                       no column, also the versions of its bits.
//     tracks_rows       which rows were written since they were last fetched (TakeRows).
//
// Bits beyond the last row are clear for toggles and unspecified for tracks, so that adding rows
// only sets marks. The archetype calls rows_added, rows_moved and so on along with the changes of
// its columns, and only if it has such components.

/// The enable bits of one chunk.
struct ToggleChunk {
    RowMask disabled;
    std::uint32_t disabled_count;
    std::uint32_t version;  ///< for a tag: when a bit last changed
};

/// The enable bits of one component.
struct ToggleBits {
    ComponentId id = 0;
    int column = 0;            ///< of the archetype; negative for a tag
    std::uint32_t newest = 0;  ///< for a tag: upper bound of the chunks' versions
    std::vector<ToggleChunk> chunks;

    [[nodiscard]] bool is_enabled(std::uint32_t row) const {
        return !chunks[row / RowMask::kRows].disabled.test(row % RowMask::kRows);
    }
    /// Returns whether the bit changed.
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

/// The rows of one column that were written since they were last fetched.
struct TrackedRows {
    ComponentId id = 0;
    int column = 0;
    std::vector<RowMask> written;  ///< per chunk

    void mark(std::uint32_t row) { written[row / RowMask::kRows].set(row % RowMask::kRows); }
    /// Atomic, for tasks that mark rows of the same chunk concurrently.
    void mark_shared(std::uint32_t row);
    void mark(std::uint32_t first, std::uint32_t count);
    /// Returns the marked rows of the chunk that are below `rows`, and clears all marks.
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
    /// nullptr if the archetype does not have the component or it cannot be toggled.
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
    /// The tracked rows of the component in the column.
    [[nodiscard]] TrackedRows* track_of_column(int column) {
        for (TrackedRows& track : tracks_) {
            if (track.column == column) {
                return &track;
            }
        }
        return nullptr;
    }

    // ---- row changes

    void add_chunk(std::uint32_t version);
    /// `count` rows from `first` on were added, enabled.
    void rows_added(std::uint32_t first, std::uint32_t count);
    /// `count` rows from `from` on replaced those from `to` on. The two ranges may overlap if
    /// to < from.
    void rows_moved(std::uint32_t from, std::uint32_t to, std::uint32_t count);
    /// `count` rows from `first` on, the last of the archetype, were removed.
    void rows_removed(std::uint32_t first, std::uint32_t count);
    /// Copies the bits of common components for rows that came from another archetype.
    void receive(const RowBits& source, std::uint32_t from, std::uint32_t to, std::uint32_t count);
    void clamp_versions(std::uint32_t oldest);

    [[nodiscard]] std::size_t bytes() const;

  private:
    std::vector<ToggleBits> toggles_;
    std::vector<TrackedRows> tracks_;
};

}  // namespace limn
