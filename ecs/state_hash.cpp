#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/component_bytes.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"

#include <algorithm>

namespace limn {

namespace {

/// A piece of a column; pieces are hashed in parallel and combined in order.
struct HashPiece {
    const ComponentInfo* info;  ///< nullptr: entities
    const std::byte* first;
    std::uint32_t count;
    const Column* lanes = nullptr;  ///< of a split component, starting at `row`
    std::uint32_t row = 0;
};

class StateHasher {
  public:
    /// Adds the values of one component, or entities, in pieces of one chunk.
    void add_column(const ComponentInfo* info, const std::byte* first, std::uint32_t count) {
        const std::size_t size = info != nullptr ? info->size : sizeof(Entity);
        for (std::uint32_t row = 0; row < count; row += kChunkRows) {
            pieces_.push_back({info, first + row * size, std::min(count - row, kChunkRows)});
        }
        parts_.push_back({pieces_.size(), info != nullptr ? hash_text(info->name) : 0, false});
    }
    /// Adds a column of an archetype.
    void add_rows(const Column& column, std::uint32_t count) {
        if (column.info->storage != Storage::Split) {
            add_column(column.info, column.data, count);
            return;
        }
        for (std::uint32_t row = 0; row < count; row += kChunkRows) {
            pieces_.push_back(
                {column.info, nullptr, std::min(count - row, kChunkRows), &column, row});
        }
        parts_.push_back({pieces_.size(), hash_text(column.info->name), false});
    }
    /// Adds the presence of a component, without a value.
    void add_presence(const ComponentInfo& info) {
        parts_.push_back({pieces_.size(), hash_text(info.name), false});
    }
    /// Adds which rows of a toggled component are disabled; nothing if none is.
    void add_disabled(const ComponentInfo& info, const ToggleBits& toggle, std::uint32_t chunks) {
        if (toggle.disabled_count() == 0) {
            return;
        }
        for (const ToggleChunk& chunk : std::span(toggle.chunks).first(chunks)) {
            static_assert(sizeof(RowMask) % sizeof(Entity) == 0);
            pieces_.push_back(
                {nullptr, reinterpret_cast<const std::byte*>(&chunk.disabled),
                 sizeof(RowMask) / sizeof(Entity)});
        }
        parts_.push_back({pieces_.size(), hash_combine(hash_text(info.name), 1), false});
    }
    /// Ends an archetype, sparse set or resource: the columns since the last end belong together.
    void end_group() { parts_.back().ends_group = true; }

    [[nodiscard]] std::uint64_t finish() const {
        std::vector<std::uint64_t> hashes(pieces_.size());
        parallel_for(pieces_.size(), kPiecesPerTask, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const HashPiece& piece = pieces_[i];
                hashes[i] =
                    piece.lanes != nullptr
                        ? hash_rows(*piece.lanes, piece.row, piece.count, piece.count)
                    : piece.info != nullptr
                        ? hash_values(*piece.info, piece.first, piece.count, piece.count)
                        : hash_bytes(piece.first, piece.count * sizeof(Entity), piece.count);
            }
        });
        // Sum over the columns of a group, and over groups, because their order depends on ids and
        // history and must not matter.
        std::uint64_t total = 0;
        std::uint64_t group = 0;
        std::size_t piece = 0;
        for (const Part& part : parts_) {
            std::uint64_t column = part.name;
            for (; piece < part.end; ++piece) {
                column = hash_combine(column, hashes[piece]);
            }
            group += hash_combine(part.name, column);
            if (part.ends_group) {
                total += hash_combine(0, group);
                group = 0;
            }
        }
        return hash_combine(total, pieces_.size());
    }

  private:
    static constexpr std::size_t kPiecesPerTask = 4;

    struct Part {
        std::size_t end;  ///< of its pieces
        std::uint64_t name;
        bool ends_group;
    };
    std::vector<HashPiece> pieces_;
    std::vector<Part> parts_;
};

}  // namespace

std::uint64_t state_hash(const World& world) {
    StateHasher hasher;
    for (const auto& archetype : world.archetypes()) {
        if (archetype->size() == 0) {
            continue;
        }
        for (const ComponentId id : archetype->components()) {
            const ComponentInfo& info = component_info(id);
            if (!info.hashed) {
                continue;
            }
            const int column = archetype->column_of(id);
            if (column == kSharedColumn) {
                const void* const value = archetype->shared_value(id)->value;
                hasher.add_column(&info, static_cast<const std::byte*>(value), 1);
            } else if (column >= 0 && is_serializable(info)) {
                hasher.add_rows(archetype->column(column), archetype->size());
            } else {
                hasher.add_presence(info);
            }
            if (const ToggleBits* toggle = archetype->bits().toggle(id); toggle != nullptr) {
                hasher.add_disabled(info, *toggle, archetype->chunk_count());
            }
        }
        const std::span<const Entity> entities = archetype->entities();
        hasher.add_column(
            nullptr, reinterpret_cast<const std::byte*>(entities.data()), archetype->size());
        hasher.end_group();
    }
    for (const SparseSet* set : world.sparse_sets()) {
        const ComponentInfo& info = set->info();
        if (set->size() == 0 || !info.hashed) {
            continue;
        }
        if (!info.is_tag && is_serializable(info)) {
            hasher.add_column(&info, set->value(0), set->size());
        } else {
            hasher.add_presence(info);
        }
        hasher.add_column(
            nullptr, reinterpret_cast<const std::byte*>(set->entities().data()), set->size());
        hasher.end_group();
    }
    for (const ComponentId id : world.resources()) {
        const ComponentInfo& info = component_info(id);
        if (info.is_resource && info.hashed && is_serializable(info) && !info.is_tag) {
            hasher.add_column(&info, static_cast<const std::byte*>(world.find_resource(id)), 1);
            hasher.end_group();
        }
    }
    return hasher.finish();
}

}  // namespace limn
