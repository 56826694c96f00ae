#pragma once

#include "ecs/reflect.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

// Deduplicated values of shared components, each identified by a key. Values are compared bytewise:
// -0 and 0 differ, and a NaN equals itself. An archetype has one value of each of its shared
// components, and their keys are part of the archetype's identity. Keys are assigned in the order
// of first use and never reused.

/// A shared component of an archetype and its value.
struct SharedValue {
    ComponentId component;
    std::uint32_t key;  ///< identifies the value
    const void* value;  ///< valid as long as the world
};

/// Inserts into a list sorted by component.
void insert_shared(std::vector<SharedValue>& list, const SharedValue& value);

class SharedValues {
  public:
    static constexpr std::uint32_t kUnknown = 0xffffffffu;

    /// The key of the value, inserted if new.
    [[nodiscard]] std::uint32_t add(const ComponentInfo& info, const void* value);
    /// kUnknown if the value was never added.
    [[nodiscard]] std::uint32_t find(const ComponentInfo& info, const void* value) const;
    [[nodiscard]] SharedValue value(std::uint32_t key) const {
        return {entries_[key].component, key, entries_[key].bytes.get()};
    }
    /// The archetypes with this value, in creation order.
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
    std::vector<std::uint32_t> table_;  ///< keys by hash, open addressing, power-of-two size
};

}  // namespace limn
