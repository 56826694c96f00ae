#pragma once

#include "ecs/base/check.h"
#include "ecs/query_state.h"

#include <cstdint>
#include <span>

namespace limn {

/// One chunk of a query: at most kChunkRows entities of one archetype.
class ChunkView {
  public:
    [[nodiscard]] std::uint32_t size() const { return size_; }
    [[nodiscard]] std::span<const Entity> entities() const {
        return archetype_->entities().subspan(first_row(), size_);
    }
    /// Index among the chunks of the query, including those that Changed skips.
    [[nodiscard]] std::uint32_t index() const { return index_; }
    /// Number of rows in the query's preceding chunks.
    [[nodiscard]] std::uint32_t offset() const { return offset_; }
    [[nodiscard]] const Archetype& archetype() const { return *archetype_; }
    /// Row of the archetype where the chunk begins.
    [[nodiscard]] std::uint32_t first_row() const { return chunk_ * kChunkRows; }
    [[nodiscard]] bool is_full() const { return size_ == kChunkRows; }

    /// Whether the chunk has the component, which need not be a term of the query.
    template <typename T>
    [[nodiscard]] bool has() const {
        return archetype_->has(component_id<T>);
    }
    /// When T last changed in the chunk: accessed for writing, or rows added, removed or moved. The
    /// chunk must have T.
    template <typename T>
    [[nodiscard]] std::uint32_t version() const {
        static_cast<void>(column_of<T>());
        return archetype_->version_of(component_id<T>, chunk_);
    }
    template <typename T>
    [[nodiscard]] bool changed_since(std::uint32_t since) const {
        return is_newer(version<T>(), since);
    }
    /// When rows were last added, removed or moved.
    [[nodiscard]] std::uint32_t structure_version() const {
        return archetype_->structure_version(chunk_);
    }

    /// Declares that T, a written term of this query, was not modified: restores its previous
    /// version.
    template <typename T>
    void mark_unchanged() const {
        const int column = column_of<T>();
        for (std::size_t i = 0; i < kMaxQueryColumns; ++i) {
            if (columns_[i] == column && column >= 0) {
                archetype_->column(column).versions[chunk_] = previous_[i];
                if constexpr (ComponentTraits<T>::tracks_rows) {
                    if (state_->writes(component_id<T>)) {
                        written<T>() = previous_written_[i];
                    }
                }
            }
        }
    }
    /// For a written component that tracks its rows: marks only these rows as written, instead of
    /// all. Call once per chunk.
    template <typename T>
    void mark_rows(const RowMask& rows) const {
        static_assert(ComponentTraits<T>::tracks_rows, "mark_rows: T does not track its rows");
        LIMN_CHECK_NOTE(
            state_->writes(component_id<T>), "mark_rows: T is not a written term of the query");
        const int column = column_of<T>();
        for (std::size_t i = 0; i < kMaxQueryColumns; ++i) {
            if (columns_[i] == column) {
                written<T>() = previous_written_[i];
                written<T>() |= rows;
            }
        }
    }

    // ---- toggled components
    // ------------------------------------------------------------------------

    /// The rows that are enabled for the query: where its toggled components are enabled, and those
    /// of Without disabled or missing; all rows if the query has no such terms. A copy from when
    /// the query reached the chunk; never empty. For Optional terms use enabled<T>().
    [[nodiscard]] const RowMask& enabled() const {
        if (all_enabled_) {
            *enabled_ = RowMask::first(size_);
        }
        return *enabled_;
    }
    [[nodiscard]] bool all_enabled() const { return all_enabled_; }
    /// The rows where T is currently enabled; T need not be a term.
    template <typename T>
    [[nodiscard]] RowMask enabled() const {
        const ToggleBits* toggle = toggle_of<T>();
        if (toggle == nullptr) {
            return {};
        }
        RowMask rows = RowMask::first(size_);
        rows -= toggle->chunks[chunk_].disabled;
        return rows;
    }
    /// Enables or disables T, a written term of this query (T or Optional<T>), for row `row` <
    /// size() of the chunk. Returns whether the bit changed, which counts as a change of T.
    template <typename T>
    bool set_enabled(std::uint32_t row, bool enabled) const {
        LIMN_CHECK_NOTE(
            state_->writes(component_id<T>), "set_enabled: T is not a written term of the query");
        ToggleBits* toggle = toggle_of<T>();
        LIMN_CHECK_NOTE(toggle != nullptr && row < size_, component_info<T>().name.c_str());
        return archetype_->set_enabled(*toggle, first_row() + row, enabled, version_);
    }

  private:
    template <typename... Terms>
    friend class Query;

    template <typename T>
    [[nodiscard]] ToggleBits* toggle_of() const {
        static_assert(
            ComponentTraits<T>::storage == Storage::Toggle,
            "T cannot be disabled: its storage is not Storage::Toggle");
        return archetype_->bits().toggle(component_id<T>);
    }
    template <typename T>
    [[nodiscard]] RowMask& written() const {
        return archetype_->bits().track(component_id<T>)->written[chunk_];
    }

    template <typename T>
    [[nodiscard]] int column_of() const {
        const int column = archetype_->column_of(component_id<T>);
        LIMN_CHECK_NOTE(column != kNoColumn, component_info<T>().name.c_str());
        return column;
    }

    Archetype* archetype_ = nullptr;
    const std::int16_t* columns_ = nullptr;      ///< of the terms with data
    const std::uint32_t* previous_ = nullptr;    ///< their versions before the query
    const RowMask* previous_written_ = nullptr;  ///< their marked rows; null: none tracks rows
    const QueryState* state_ = nullptr;
    RowMask* enabled_ = nullptr;  ///< unspecified if all_enabled_
    std::uint32_t chunk_ = 0;
    std::uint32_t size_ = 0;
    std::uint32_t index_ = 0;
    std::uint32_t offset_ = 0;
    std::uint32_t version_ = 0;  ///< assigned to what the query writes
    bool all_enabled_ = true;
};

}  // namespace limn
