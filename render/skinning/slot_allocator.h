#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace limn {

/// Ranges of one long array, given out and given back. First fit, and neighbors that are free
/// become one: the same requests in the same order get the same places.
class SlotAllocator {
  public:
    /// The first item of `count` > 0 in a row; none if nowhere so many are free: grow().
    [[nodiscard]] std::optional<std::uint32_t> allocate(std::uint32_t count);
    /// Gives back what allocate(count) gave.
    void release(std::uint32_t first, std::uint32_t count);
    /// Adds free items at the end; `capacity` is no less than before.
    void grow(std::uint32_t capacity);
    void clear();

    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    [[nodiscard]] std::uint32_t used() const { return used_; }
    /// How many ranges the free items are in.
    [[nodiscard]] std::size_t gaps() const { return free_.size(); }

  private:
    void add_free(std::uint32_t first, std::uint32_t count);

    std::map<std::uint32_t, std::uint32_t> free_;  ///< first item to count
    std::uint32_t capacity_ = 0;
    std::uint32_t used_ = 0;
};

}  // namespace limn
