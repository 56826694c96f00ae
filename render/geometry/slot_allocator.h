#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace limn {

/// First-fit allocator of ranges in one long array; adjacent free ranges are merged. The same
/// requests in the same order return the same ranges.
class SlotAllocator {
  public:
    /// First of `count` > 0 consecutive items; nullopt if no free range is large enough.
    [[nodiscard]] std::optional<std::uint32_t> allocate(std::uint32_t count);
    /// The same; if there is no such range, grows to at least twice the capacity and at least
    /// `min_capacity`.
    [[nodiscard]] std::uint32_t
    allocate_or_grow(std::uint32_t count, std::uint32_t min_capacity = 0);
    /// Frees a range returned by allocate(count).
    void release(std::uint32_t first, std::uint32_t count);
    /// Adds free items at the end; `capacity` must not shrink.
    void grow(std::uint32_t capacity);
    void clear();

    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    [[nodiscard]] std::uint32_t used() const { return used_; }
    /// Number of free ranges.
    [[nodiscard]] std::size_t gaps() const { return free_.size(); }

  private:
    void add_free(std::uint32_t first, std::uint32_t count);

    std::map<std::uint32_t, std::uint32_t> free_;  ///< first item to count
    std::uint32_t capacity_ = 0;
    std::uint32_t used_ = 0;
};

}  // namespace limn
