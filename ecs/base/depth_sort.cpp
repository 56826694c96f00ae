#include "ecs/base/depth_sort.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

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

/// The same on one thread, where slots are known already.
template <typename Read, typename Digit, typename Write>
void move_by_digit(std::size_t count, std::uint32_t* next, Read read, Digit digit, Write write) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto item = read(i);
        write(next[digit(item)]++, item);
    }
}

/// Digit counts of all passes at once: they do not depend on the order. kPasses tables of
/// 1 << kBits slots.
template <std::size_t kBits, std::size_t kPasses, typename Key>
void count_digits(std::span<const Key> keys, std::vector<std::uint32_t>& slots) {
    constexpr std::size_t kDigits = std::size_t{1} << kBits;
    slots.assign(kPasses * kDigits, 0);
    std::uint32_t* const counts = slots.data();
    for (const Key key : keys) {
        for (std::size_t pass = 0; pass < kPasses; ++pass) {
            ++counts[pass * kDigits + ((key >> (pass * kBits)) & (kDigits - 1))];
        }
    }
    for (std::size_t pass = 0; pass < kPasses; ++pass) {
        place_digits(std::span(slots).subspan(pass * kDigits, kDigits), kDigits);
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
        count_digits<8, 2>(keys, slots);
        move_by_digit(count, slots.data(), read_key, low, write_item);
        move_by_digit(count, slots.data() + 256, read_item, high, write_index);
    }
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
    const float share = std::clamp((farthest - depth) / (farthest - nearest), 0.0f, 1.0f);
    return static_cast<std::uint16_t>(1.0f + share * 65534.0f);
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
    const std::size_t count = keys.size();
    for (std::vector<SortItem>& items : scratch.items) {
        items.resize(count);
    }
    std::uint32_t* const indices = order.data();
    SortItem* const a = scratch.items[0].data();
    SortItem* const b = scratch.items[1].data();
    const auto read_key = [keys = keys.data(), indices](std::size_t i) {
        return SortItem{keys[indices[i]]} << 32 | indices[i];
    };
    const auto read_a = [a](std::size_t i) { return a[i]; };
    const auto read_b = [b](std::size_t i) { return b[i]; };
    const auto low = [](SortItem item) { return (item >> 32) & 2047; };
    const auto middle = [](SortItem item) { return (item >> 43) & 2047; };
    const auto high = [](SortItem item) { return item >> 54; };
    const auto write_a = [a](std::uint32_t slot, SortItem item) { a[slot] = item; };
    const auto write_b = [b](std::uint32_t slot, SortItem item) { b[slot] = item; };
    const auto write_index = [indices](std::uint32_t slot, SortItem item) {
        indices[slot] = static_cast<std::uint32_t>(item);
    };
    if (threads == SortThreads::All && count > kGrain) {
        sort_digit(count, 2048, scratch.slots, read_key, low, write_a);
        sort_digit(count, 2048, scratch.slots, read_a, middle, write_b);
        sort_digit(count, 2048, scratch.slots, read_b, high, write_index);
    } else {
        count_digits<11, 3>(keys, scratch.slots);
        move_by_digit(count, scratch.slots.data(), read_key, low, write_a);
        move_by_digit(count, scratch.slots.data() + 2048, read_a, middle, write_b);
        move_by_digit(count, scratch.slots.data() + 4096, read_b, high, write_index);
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
