#pragma once

#include "ecs/base/hash.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace limn {

// Hash tables of the book, chapter 11. The engine's own lookups are std::unordered_map and, for
// entities and components, arrays by index; `limn bench tables` compares them.

/// Slot of an integer key: k modulo n, not negative (engine.hash-bucket). n should be prime: with a
/// power of two, keys that are multiples of it share a slot.
[[nodiscard]] constexpr std::size_t slot_of(std::int64_t key, std::size_t slots) {
    const auto n = static_cast<std::int64_t>(slots);
    return static_cast<std::size_t>((key % n + n) % n);
}

/// The book's hash of a name: the sum of its characters. Anagrams collide.
[[nodiscard]] constexpr std::int64_t character_sum(std::string_view name) {
    std::int64_t sum = 0;
    for (const char c : name) {
        sum += static_cast<unsigned char>(c);
    }
    return sum;
}

enum class NameHash : std::uint8_t {
    CharacterSum,  ///< the book's
    Fnv,           ///< FNV-1a
};

/// A hash table of growable slots, each searched from its begin (engine.hash-bucket). `Key` is an
/// integer or a name. A key that exists is rejected.
template <typename Key, typename Value>
class BucketTable {
  public:
    explicit BucketTable(std::size_t slots, NameHash hash = NameHash::Fnv)
        : slots_(std::max<std::size_t>(slots, 1)), hash_(hash) {}

    /// False, and nothing changes, if the key exists.
    bool add(Key key, Value value) {
        if (find(key) != nullptr) {
            return false;
        }
        slots_[slot(key)].push_back({std::move(key), std::move(value)});
        return true;
    }
    /// False if there is no such key.
    bool remove(const Key& key) {
        return std::erase_if(
                   slots_[slot(key)], [&](const auto& entry) { return entry.first == key; })
               > 0;
    }
    /// nullptr if there is no such key. `compared`, if given, counts the keys looked at.
    [[nodiscard]] const Value* find(const Key& key, std::size_t* compared = nullptr) const {
        for (const auto& entry : slots_[slot(key)]) {
            if (compared != nullptr) {
                ++*compared;
            }
            if (entry.first == key) {
                return &entry.second;
            }
        }
        return nullptr;
    }
    [[nodiscard]] std::size_t slot(const Key& key) const {
        if constexpr (std::is_integral_v<Key>) {
            return slot_of(static_cast<std::int64_t>(key), slots_.size());
        } else {
            return slot_of(
                hash_ == NameHash::Fnv ? std::int64_t{name_hash(key)} : character_sum(key),
                slots_.size());
        }
    }
    [[nodiscard]] std::size_t longest_slot() const {
        std::size_t longest = 0;
        for (const auto& one : slots_) {
            longest = std::max(longest, one.size());
        }
        return longest;
    }

  private:
    std::vector<std::vector<std::pair<Key, Value>>> slots_;
    NameHash hash_;
};

/// Open addressing (engine.hash-probe): a name that finds its slot taken tries the slots `step`,
/// 2 `step` ... further on. `step` and the number of slots must be coprime to reach all of them.
class ProbeTable {
  public:
    ProbeTable(std::size_t slots, std::size_t step) : slots_(slots), step_(step) {}

    /// The slot, from `first` on; none if the name exists or all slots that it reaches are taken.
    std::optional<std::size_t> add(std::string_view name, std::size_t first) {
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            std::string& slot = slots_[probe(first, i)];
            if (slot.empty()) {
                slot = name;
                return probe(first, i);
            }
            if (slot == name) {
                break;
            }
        }
        return std::nullopt;
    }
    /// How many slots are looked at until the name is found; none if it is missing.
    [[nodiscard]] std::optional<std::size_t>
    search(std::string_view name, std::size_t first) const {
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            const std::string& slot = slots_[probe(first, i)];
            if (slot.empty()) {
                break;
            }
            if (slot == name) {
                return i + 1;
            }
        }
        return std::nullopt;
    }
    [[nodiscard]] const std::vector<std::string>& slots() const { return slots_; }

  private:
    [[nodiscard]] std::size_t probe(std::size_t first, std::size_t i) const {
        return (first + i * step_) % slots_.size();
    }

    std::vector<std::string> slots_;  ///< empty: free
    std::size_t step_;
};

}  // namespace limn
