#include "bench/particles/particle_race.h"
#include "bench/particles/particle_rows.h"
#include "ecs/base/depth_sort.h"
#include "ecs/base/rng.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

// Back-to-front order, and what it costs to draw in that order.

namespace limn::bench {
namespace {

constexpr std::size_t kMany = 1000000;

template <typename Key>
std::vector<Key> random_keys(std::size_t count) {
    Random random(1, 2, 3, 4);
    std::vector<Key> keys(count);
    for (Key& key : keys) {
        const std::uint32_t word = depth_key(-random.uniform(0.1f, 1000.0f));
        key = static_cast<Key>(sizeof(Key) == 2 ? random.word() >> 16 : word);
    }
    return keys;
}

std::vector<std::uint64_t> keys_with_indices(std::span<const std::uint32_t> keys) {
    std::vector<std::uint64_t> packed(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        packed[i] = std::uint64_t{keys[i]} << 32 | i;
    }
    return packed;
}

template <typename Key>
void add_sort_row(
    ParticleBench& bench, const char* number, const char* name, std::size_t count,
    SortThreads threads, double limit) {
    const std::vector<Key> keys = random_keys<Key>(count);
    const std::vector<std::uint64_t> packed =
        keys_with_indices(std::vector<std::uint32_t>(keys.begin(), keys.end()));
    std::vector<std::uint32_t> order(count);
    std::vector<std::uint64_t> sorted(count);
    SortScratch scratch;
    const auto [ours, standard] = race(
        count, [&] { std::iota(order.begin(), order.end(), 0u); },
        [&] { sort_by_depth(std::span<const Key>(keys), order, scratch, threads); },
        [&] { sorted = packed; }, [&] { std::sort(sorted.begin(), sorted.end()); });
    bench.add(GateRow{number, name, ours, standard, "std::sort of 64 bits", "ns", limit});
}

/// Gathers 32 bytes each in the order of depths: a random one, and one in which only neighbors are
/// swapped.
void add_gather_rows(ParticleBench& bench) {
    using Instance = std::array<std::uint32_t, 8>;
    std::vector<std::uint32_t> keys = random_keys<std::uint32_t>(kMany);
    const std::vector<std::uint64_t> packed = keys_with_indices(keys);
    std::vector<std::uint64_t> sorted(kMany);
    const std::vector<Instance> instances(kMany);
    std::vector<Instance> drawn(kMany);
    std::vector<std::uint32_t> order(kMany);
    SortScratch scratch;
    for (const bool kept : {false, true}) {
        std::iota(order.begin(), order.end(), 0u);
        if (kept) {
            Random random(9, 9, 9, 9);
            for (std::size_t i = 0; i + 8 < kMany; ++i) {
                std::swap(order[i], order[i + random.word() % 8]);
            }
        } else {
            sort_by_depth(std::span<const std::uint32_t>(keys), order, scratch);
        }
        const auto [ours, standard] = race(
            kMany, kUnprepared,
            [&] {
                for (std::size_t i = 0; i < kMany; ++i) {
                    drawn[i] = instances[order[i]];
                }
            },
            [&] { sorted = packed; }, [&] { std::sort(sorted.begin(), sorted.end()); });
        bench.add(GateRow{
            "12", kept ? "gather 1M in the kept order" : "gather 1M in a random order", ours,
            standard, "std::sort of 64 bits", "ns", kept ? 0.12 : 0.25});
    }
}

}  // namespace

void add_sort_rows(ParticleBench& bench) {
    constexpr auto kOne = SortThreads::One;
    constexpr auto kAll = SortThreads::All;
    add_sort_row<std::uint32_t>(bench, "10", "sort 100k by 32 bits", 100000, kOne, 0.1);
    add_sort_row<std::uint32_t>(bench, "10", "sort 1M by 32 bits", kMany, kOne, 0.13);
    add_sort_row<std::uint16_t>(bench, "10", "sort 100k by 16 bits", 100000, kOne, 0.1);
    add_sort_row<std::uint16_t>(bench, "10", "sort 1M by 16 bits", kMany, kOne, 0.13);
    add_sort_row<std::uint32_t>(bench, "11", "sort 1M by 32 bits, all threads", kMany, kAll, 0.11);
    add_sort_row<std::uint16_t>(bench, "11", "sort 1M by 16 bits, all threads", kMany, kAll, 0.11);
    add_gather_rows(bench);
}

}  // namespace limn::bench
