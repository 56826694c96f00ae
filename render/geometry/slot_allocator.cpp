#include "render/geometry/slot_allocator.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <iterator>

namespace limn {

std::optional<std::uint32_t> SlotAllocator::allocate(std::uint32_t count) {
    LIMN_CHECK(count > 0);
    for (auto it = free_.begin(); it != free_.end(); ++it) {
        const auto [first, length] = *it;
        if (length < count) {
            continue;
        }
        free_.erase(it);
        if (length > count) {
            free_.emplace(first + count, length - count);
        }
        used_ += count;
        return first;
    }
    return std::nullopt;
}

std::uint32_t SlotAllocator::allocate_or_grow(std::uint32_t count, std::uint32_t min_capacity) {
    std::optional<std::uint32_t> first = allocate(count);
    if (!first) {
        grow(std::max({capacity_ + count, 2 * capacity_, min_capacity}));
        first = allocate(count);
    }
    return *first;
}

void SlotAllocator::release(std::uint32_t first, std::uint32_t count) {
    LIMN_CHECK(count > 0 && count <= used_ && first + count <= capacity_);
    used_ -= count;
    add_free(first, count);
}

void SlotAllocator::grow(std::uint32_t capacity) {
    LIMN_CHECK(capacity >= capacity_);
    if (capacity > capacity_) {
        const std::uint32_t first = capacity_;
        capacity_ = capacity;
        add_free(first, capacity - first);
    }
}

void SlotAllocator::clear() {
    free_.clear();
    used_ = 0;
    if (capacity_ > 0) {
        free_.emplace(0, capacity_);
    }
}

void SlotAllocator::add_free(std::uint32_t first, std::uint32_t count) {
    const auto after = free_.lower_bound(first);
    if (after != free_.end() && after->first == first + count) {
        count += after->second;
        free_.erase(after);
    }
    const auto next = free_.lower_bound(first);
    if (next != free_.begin()) {
        const auto before = std::prev(next);
        if (before->first + before->second == first) {
            before->second += count;
            return;
        }
    }
    free_.emplace(first, count);
}

}  // namespace limn
