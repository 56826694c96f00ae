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
    /// Position among the chunks of the query; those that Changed leaves out count too.
    [[nodiscard]] std::uint32_t index() const { return index_; }
    /// How many entities of the query come before.
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
    /// When T last changed in the chunk: taken for writing, or rows came, went or moved. T must be
    /// there.
    template <typename T>
    [[nodiscard]] std::uint32_t version() const {
        return archetype_->version(column_of<T>(), chunk_);
    }
    template <typename T>
    [[nodiscard]] bool changed_since(std::uint32_t since) const {
        return is_newer(version<T>(), since);
    }
    /// When rows last came, went or moved.
    [[nodiscard]] std::uint32_t structure_version() const {
        return archetype_->structure_version(chunk_);
    }

    /// Takes back that this query took T for writing: nothing was written. T is a term of the
    /// query.
    template <typename T>
    void mark_unchanged() const {
        const int column = column_of<T>();
        for (std::size_t i = 0; i < kMaxQueryColumns; ++i) {
            if (columns_[i] == column && column >= 0) {
                archetype_->column(column).versions[chunk_] = previous_[i];
            }
        }
    }

  private:
    template <typename... Terms>
    friend class Query;

    template <typename T>
    [[nodiscard]] int column_of() const {
        const int column = archetype_->column_of(component_id<T>);
        LIMN_CHECK_NOTE(column != kNoColumn, component_info<T>().name.c_str());
        return column;
    }

    Archetype* archetype_ = nullptr;
    const std::int16_t* columns_ = nullptr;    ///< of the terms with data
    const std::uint32_t* previous_ = nullptr;  ///< their versions before the query
    std::uint32_t chunk_ = 0;
    std::uint32_t size_ = 0;
    std::uint32_t index_ = 0;
    std::uint32_t offset_ = 0;
};

}  // namespace limn
