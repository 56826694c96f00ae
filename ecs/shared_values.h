#pragma once

#include "ecs/reflect.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

// The values that shared components have, each kept once and known by a number. Two values are the
// same if their bytes are; so -0 and 0 are two, and a NaN is the same as itself. An archetype has
// one value of each of its shared components, and its numbers are part of what tells it from other
// archetypes. Numbers are given in the order of first use and never taken back.

/// A shared component of an archetype and its value.
struct SharedValue {
    ComponentId component;
    std::uint32_t key;  ///< number of the value
    const void* value;  ///< stays where it is as long as the world does
};

/// Keeps the list ascending by component.
void insert_shared(std::vector<SharedValue>& list, const SharedValue& value);

class SharedValues {
  public:
    static constexpr std::uint32_t kUnknown = 0xffffffffu;

    /// The number of the value, a new one if nothing has had it yet.
    [[nodiscard]] std::uint32_t add(const ComponentInfo& info, const void* value);
    /// kUnknown: nothing ever had the value.
    [[nodiscard]] std::uint32_t find(const ComponentInfo& info, const void* value) const;
    [[nodiscard]] SharedValue value(std::uint32_t key) const {
        return {entries_[key].component, key, entries_[key].bytes.get()};
    }
    /// The archetypes that have the value, in the order of their creation.
    [[nodiscard]] std::span<const std::uint32_t> archetypes(std::uint32_t key) const {
        return entries_[key].archetypes;
    }
    void add_archetype(std::uint32_t key, std::uint32_t archetype) {
        entries_[key].archetypes.push_back(archetype);
    }
    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
    void clear();

  private:
    struct Entry {
        ComponentId component;
        std::uint64_t hash;
        std::unique_ptr<std::byte[]> bytes;
        std::vector<std::uint32_t> archetypes;
    };

    [[nodiscard]] std::uint32_t
    find(const ComponentInfo& info, const void* value, std::uint64_t hash) const;
    void insert(std::uint32_t key);

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> table_;  ///< keys by hash, open addressing, a power of two long
};

}  // namespace limn
