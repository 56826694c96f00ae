#pragma once

#include "ecs/archetype.h"
#include "ecs/column.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

// Storage of one sparse component: a dense array of values in insertion order, except that a
// removal moves the last value into the hole; and a map from entity index to position. Adding and
// removing touches nothing else of the entity. Has versions per chunk of values, like an archetype.

class SparseSet {
  public:
    explicit SparseSet(const ComponentInfo& info);
    SparseSet(const SparseSet&) = delete;
    SparseSet& operator=(const SparseSet&) = delete;
    ~SparseSet();

    static constexpr std::uint32_t kAbsent = 0xffffffffu;

    [[nodiscard]] const ComponentInfo& info() const { return *column_.info; }
    [[nodiscard]] std::uint32_t size() const { return size_; }
    [[nodiscard]] std::span<const Entity> entities() const {
        return {reinterpret_cast<const Entity*>(entities_.data()), size_};
    }
    /// Position of the value, or kAbsent.
    [[nodiscard]] std::uint32_t find(Entity entity) const {
        const std::uint32_t page = entity.index / kPageSize;
        if (page >= pages_.size() || pages_[page] == nullptr) {
            return kAbsent;
        }
        const std::uint32_t position = pages_[page][entity.index % kPageSize];
        return position != kAbsent && entities()[position] == entity ? position : kAbsent;
    }
    [[nodiscard]] bool has(Entity entity) const { return find(entity) != kAbsent; }
    /// Must not be dereferenced for tags.
    [[nodiscard]] std::byte* value(std::uint32_t position) const { return column_.at(position); }

    /// Adds a value, as raw memory; returns its position. The entity must have none yet.
    std::uint32_t append(Entity entity, std::uint32_t version);
    /// Destroys the value at `position`.
    void remove(std::uint32_t position, std::uint32_t version);
    void clear(std::uint32_t version);
    /// Releases unused memory.
    void shrink();

    [[nodiscard]] std::uint32_t version(std::uint32_t position) const {
        return column_.versions[position / kChunkRows];
    }
    [[nodiscard]] std::uint32_t newest_version() const { return column_.newest; }
    void touch(std::uint32_t position, std::uint32_t version) {
        store_version(column_.versions[position / kChunkRows], version);
        store_version(column_.newest, version);
    }
    void clamp_versions(std::uint32_t oldest);
    [[nodiscard]] std::size_t committed() const;

    bool observes_add = false;
    bool observes_remove = false;

  private:
    static constexpr std::uint32_t kPageSize = 4096;

    Column column_;
    VirtualRange entities_;
    std::uint32_t size_ = 0;
    std::vector<std::unique_ptr<std::uint32_t[]>> pages_;
};

}  // namespace limn
