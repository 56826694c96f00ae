#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

// Techniques: engine.containers
// Shown by `limn render vale -o vale.png`: engine.containers

namespace limn {

/// A list of fixed capacity in slots that it does not own: the item at index 0 is the oldest, and
/// neither end moves the others. For components, whose state is the slots, the slot of the oldest
/// item and the number of items.
template <typename T>
class Ring {
  public:
    using Number = std::conditional_t<std::is_const_v<T>, const std::uint32_t, std::uint32_t>;

    Ring(std::span<T> slots, Number& first, Number& count)
        : slots_(slots), first_(first), count_(count) {}

    [[nodiscard]] std::uint32_t size() const { return count_; }
    [[nodiscard]] bool is_full() const { return count_ == slots_.size(); }
    /// `index` is less than size().
    [[nodiscard]] T& operator[](std::uint32_t index) const { return slots_[slot_of(index)]; }

    /// Adds the newest item. Changes nothing and returns false if it is full.
    bool push_back(const T& item) {
        if (is_full()) {
            return false;
        }
        slots_[slot_of(count_)] = item;
        ++count_;
        return true;
    }
    /// Removes the oldest item. Returns false if it is empty.
    bool pop_front() {
        if (count_ == 0) {
            return false;
        }
        first_ = static_cast<std::uint32_t>(slot_of(1));
        --count_;
        return true;
    }

  private:
    [[nodiscard]] std::size_t slot_of(std::uint32_t index) const {
        return (std::size_t{first_} + index) % slots_.size();
    }

    std::span<T> slots_;
    Number& first_;
    Number& count_;
};

}  // namespace limn
