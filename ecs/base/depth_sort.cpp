#include "ecs/base/depth_sort.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

// Techniques: particle.bitonic-sort, particle.distance-sort

namespace limn {

namespace {

/// Key and index: key << 32 | index.
using SortItem = std::uint64_t;

/// Particles per range of a parallel sort; the same for any number of threads.
constexpr std::size_t kGrain = std::size_t{1} << 16;

/// Replaces counts by where each digit of each range begins: by digit, then by range.
void place_digits(std::span<std::uint32_t> counts, std::size_t digits) {
    std::uint32_t begin = 0;
    for (std::size_t digit = 0; digit < digits; ++digit) {
        for (std::size_t i = digit; i < counts.size(); i += digits) {
            begin += std::exchange(counts[i], begin);
        }
    }
}

/// One pass of a parallel radix sort: write(slot, read(i)) for all i, by digit(read(i)) < digits.
template <typename Read, typename Digit, typename Write>
void sort_digit(
    std::size_t count, std::size_t digits, std::vector<std::uint32_t>& slots, Read read,
    Digit digit, Write write) {
    slots.assign(((count - 1) / kGrain + 1) * digits, 0);
    parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* const counts = slots.data() + begin / kGrain * digits;
        for (std::size_t i = begin; i < end; ++i) {
            ++counts[digit(read(i))];
        }
    });
    place_digits(slots, digits);
    parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* const next = slots.data() + begin / kGrain * digits;
        for (std::size_t i = begin; i < end; ++i) {
            const auto item = read(i);
            write(next[digit(item)]++, item);
        }
    });
}

/// The same on one thread, where slots are known already; see(item) while it is at hand.
template <typename Read, typename Digit, typename Write, typename See>
void move_by_digit(
    std::size_t count, std::uint32_t* next, Read read, Digit digit, Write write, See see) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto item = read(i);
        see(item);
        write(next[digit(item)]++, item);
    }
}

/// Between the passes an item is what is left of the key, above kShift bits of index.
template <typename Item, int kShift>
void sort_16(
    std::span<const std::uint16_t> keys, std::span<std::uint32_t> order, std::vector<Item>& items,
    std::vector<std::uint32_t>& slots, SortThreads threads) {
    struct Keyed {
        std::uint32_t index;
        std::uint16_t key;
    };
    const std::size_t count = keys.size();
    items.resize(count);
    std::uint32_t* const indices = order.data();
    Item* const between = items.data();
    const auto read_key = [keys = keys.data(), indices](std::size_t i) {
        return Keyed{indices[i], keys[indices[i]]};
    };
    const auto low = [](Keyed item) { return item.key & 255u; };
    const auto write_item = [between](std::uint32_t slot, Keyed item) {
        between[slot] = (Item{static_cast<std::uint32_t>(item.key >> 8)} << kShift) | item.index;
    };
    const auto read_item = [between](std::size_t i) { return between[i]; };
    const auto high = [](Item item) { return static_cast<std::uint32_t>(item >> kShift); };
    const auto write_index = [indices](std::uint32_t slot, Item item) {
        indices[slot] = static_cast<std::uint32_t>(item & ((Item{1} << kShift) - 1));
    };
    if (threads == SortThreads::All && count > kGrain) {
        sort_digit(count, 256, slots, read_key, low, write_item);
        sort_digit(count, 256, slots, read_item, high, write_index);
    } else {
        slots.assign(2 * 256, 0);
        const std::span<std::uint32_t> first = std::span(slots).first(256);
        const std::span<std::uint32_t> second = std::span(slots).last(256);
        for (const std::uint16_t key : keys) {
            ++first[key & 255u];
        }
        place_digits(first, 256);
        move_by_digit(count, first.data(), read_key, low, write_item, [second](Keyed item) {
            ++second[item.key >> 8];
        });
        place_digits(second, 256);
        move_by_digit(count, second.data(), read_item, high, write_index, [](Item) {});
    }
}

/// Three passes of kBits. The fewer digits, the fewer positions that are written in turn: 512 of
/// them stay in the cache. On one thread a pass counts the digits of the next one. False, and
/// nothing is sorted, where keys differ by more than the highest digit can tell.
template <int kBits>
bool sort_32(
    std::span<const std::uint32_t> keys, std::span<std::uint32_t> order, SortScratch& scratch,
    SortThreads threads) {
    constexpr std::uint32_t kDigits = 1u << kBits;
    constexpr std::uint32_t kMask = kDigits - 1;
    const std::size_t count = keys.size();
    scratch.slots.assign(3 * kDigits, 0);
    std::uint32_t* const first = scratch.slots.data();
    std::uint32_t* const second = first + kDigits;
    std::uint32_t* const third = second + kDigits;
    std::uint32_t lowest = 0xffffffff;
    std::uint32_t highest = 0;
    for (const std::uint32_t key : keys) {
        lowest = std::min(lowest, key);
        highest = std::max(highest, key);
        ++first[key & kMask];
    }
    const std::uint32_t base = lowest >> (2 * kBits);
    if (count > 0 && (highest >> (2 * kBits)) - base >= kDigits) {
        return false;
    }

    std::uint32_t* const indices = order.data();
    SortItem* const a = scratch.items[0].data();
    SortItem* const b = scratch.items[1].data();
    const auto read_key = [keys = keys.data(), indices](std::size_t i) {
        return SortItem{keys[indices[i]]} << 32 | indices[i];
    };
    const auto read_a = [a](std::size_t i) { return a[i]; };
    const auto read_b = [b](std::size_t i) { return b[i]; };
    const auto low = [](SortItem item) { return (item >> 32) & kMask; };
    const auto middle_digit = [](SortItem item) { return (item >> (32 + kBits)) & kMask; };
    const auto high = [base](SortItem item) { return (item >> (32 + 2 * kBits)) - base; };
    const auto write_a = [a](std::uint32_t slot, SortItem item) { a[slot] = item; };
    const auto write_b = [b](std::uint32_t slot, SortItem item) { b[slot] = item; };
    const auto write_index = [indices](std::uint32_t slot, SortItem item) {
        indices[slot] = static_cast<std::uint32_t>(item);
    };
    if (threads == SortThreads::All && count > kGrain) {
        sort_digit(count, kDigits, scratch.slots, read_key, low, write_a);
        sort_digit(count, kDigits, scratch.slots, read_a, middle_digit, write_b);
        sort_digit(count, kDigits, scratch.slots, read_b, high, write_index);
        return true;
    }
    const auto count_middle = [second, middle_digit](SortItem item) {
        ++second[middle_digit(item)];
    };
    const auto see_high = [third, high](SortItem item) { ++third[high(item)]; };
    place_digits({first, kDigits}, kDigits);
    move_by_digit(count, first, read_key, low, write_a, count_middle);
    place_digits({second, kDigits}, kDigits);
    move_by_digit(count, second, read_a, middle_digit, write_b, see_high);
    place_digits({third, kDigits}, kDigits);
    move_by_digit(count, third, read_b, high, write_index, [](SortItem) {});
    return true;
}

}  // namespace

std::uint32_t depth_key(float depth) {
    if (std::isnan(depth)) {
        return 0;
    }
    const auto bits = std::bit_cast<std::uint32_t>(depth + 0.0f);  // -0 becomes 0
    const std::uint32_t ascending = bits ^ ((bits >> 31) != 0 ? 0xffffffffu : 0x80000000u);
    return ~ascending;  // 0x007fffff for +infinity
}

std::uint16_t depth_key16(float depth, float nearest, float farthest) {
    if (std::isnan(depth)) {
        return 0;
    }
    const float nearness = std::clamp((farthest - depth) / (farthest - nearest), 0.0f, 1.0f);
    return static_cast<std::uint16_t>(1.0f + nearness * 65534.0f);
}

void sort_by_depth(
    std::span<const std::uint16_t> keys, std::span<std::uint32_t> order, SortScratch& scratch,
    SortThreads threads) {
    LIMN_CHECK(keys.size() == order.size() && keys.size() <= 0xffffffffu);
    if (keys.size() <= 1u << 24) {  // half the memory traffic
        sort_16<std::uint32_t, 24>(keys, order, scratch.packed, scratch.slots, threads);
    } else {
        sort_16<std::uint64_t, 32>(keys, order, scratch.items[0], scratch.slots, threads);
    }
}

void sort_by_depth(
    std::span<const std::uint32_t> keys, std::span<std::uint32_t> order, SortScratch& scratch,
    SortThreads threads) {
    LIMN_CHECK(keys.size() == order.size() && keys.size() <= 0xffffffffu);
    for (std::vector<SortItem>& items : scratch.items) {
        items.resize(keys.size());
    }
    // Three passes of 9 bits tell depths of 0.02 m to 1 km apart.
    if (!sort_32<9>(keys, order, scratch, threads)) {
        sort_32<11>(keys, order, scratch, threads);
    }
}

std::uint32_t bitonic_pass_count(std::size_t count) {
    LIMN_CHECK(std::has_single_bit(count));
    const auto levels = static_cast<std::uint32_t>(std::countr_zero(count));
    return levels * (levels + 1) / 2;
}

BitonicPass bitonic_pass_at(std::uint32_t number) {
    std::uint32_t level = 1;  // level l has l passes
    while (number >= level) {
        number -= level++;
    }
    return {.run = 1u << level, .partner = 1u << (level - 1 - number)};
}

}  // namespace limn
