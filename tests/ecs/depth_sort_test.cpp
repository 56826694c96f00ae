#include "ecs/base/depth_sort.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

using namespace limn;

namespace {

std::vector<std::uint32_t> first_to_last(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> order = first_to_last(count);
    Random random(seed, count, 1, 0);
    for (std::size_t i = count; i > 1; --i) {
        std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
    }
    return order;
}

/// Keys of which about `distinct` differ.
template <typename Key>
std::vector<Key> random_keys(std::size_t count, std::uint32_t distinct) {
    std::vector<Key> keys(count);
    Random random(7, count, distinct, 0);
    for (Key& key : keys) {
        key = static_cast<Key>(random.below(distinct) * 0x9e3779b1u);
    }
    return keys;
}

template <typename Key>
std::vector<std::uint32_t>
stable_order(const std::vector<Key>& keys, std::vector<std::uint32_t> order) {
    std::stable_sort(order.begin(), order.end(), [&keys](std::uint32_t a, std::uint32_t b) {
        return keys[a] < keys[b];
    });
    return order;
}

template <typename Key>
void check_equals_stable_sort() {
    SortScratch scratch;
    for (const std::size_t count : {0, 1, 2, 3, 255, 1000, 65536, 65537, 200000}) {
        for (const std::uint32_t distinct : {1u, 5u, 65535u}) {
            const std::vector<Key> keys = random_keys<Key>(count, distinct);
            const std::vector<std::uint32_t> start = shuffled(count, 3);
            const std::vector<std::uint32_t> expected = stable_order(keys, start);
            for (const SortThreads threads : {SortThreads::One, SortThreads::All}) {
                std::vector<std::uint32_t> order = start;
                sort_by_depth(std::span<const Key>(keys), order, scratch, threads);
                CAPTURE(count);
                CAPTURE(distinct);
                CHECK(order == expected);
            }
        }
    }
}

/// The network that bitonic_pass_at() describes.
void do_all_passes(std::vector<std::uint32_t>& entries) {
    for (std::uint32_t number = 0; number < bitonic_pass_count(entries.size()); ++number) {
        const BitonicPass pass = bitonic_pass_at(number);
        for (std::uint32_t i = 0; i < entries.size(); ++i) {
            const std::uint32_t other = i ^ pass.partner;
            if (i < other && (entries[i] > entries[other]) == ((i & pass.run) == 0)) {
                std::swap(entries[i], entries[other]);
            }
        }
    }
}

}  // namespace

TEST_CASE("particle sort: 16-bit keys are sorted as by std::stable_sort") {
    check_equals_stable_sort<std::uint16_t>();
}

TEST_CASE("particle sort: 32-bit keys are sorted as by std::stable_sort") {
    check_equals_stable_sort<std::uint32_t>();
}

TEST_CASE(
    "particle sort: 32-bit keys are sorted whatever their range and however small their differences"
    * technique("particle.distance-sort")) {
    SortScratch scratch;
    constexpr std::uint32_t kEnd = 0xffffffff;
    for (const std::uint32_t range : {1u, 0x3ffu, 0x7fbffffu, 0x8000000u, 0x8100000u, kEnd}) {
        for (const std::uint32_t low : {0u, std::min(0x3dccccccu, kEnd - range), kEnd - range}) {
            CAPTURE(range);
            CAPTURE(low);
            std::vector<std::uint32_t> keys(70000);
            Random random(7, low, range, 0);
            for (std::uint32_t& key : keys) {
                key = low + random.below(range);
            }
            keys[1] = low;
            keys[2] = low + range;
            const std::vector<std::uint32_t> start = shuffled(keys.size(), 3);
            const std::vector<std::uint32_t> expected = stable_order(keys, start);
            for (const SortThreads threads : {SortThreads::One, SortThreads::All}) {
                std::vector<std::uint32_t> order = start;
                sort_by_depth(std::span<const std::uint32_t>(keys), order, scratch, threads);
                CHECK(order == expected);
            }
        }
    }
}

TEST_CASE("particle sort: any number of threads gives the same bits") {
    const std::vector<std::uint32_t> keys = random_keys<std::uint32_t>(300000, 1000);
    const std::vector<std::uint32_t> expected = stable_order(keys, first_to_last(keys.size()));
    const int before = thread_count();
    SortScratch scratch;
    for (const int threads : {1, 2, 3, 8}) {
        for (const std::uint64_t seed : {0, 1, 2}) {
            set_thread_count(threads);
            set_task_shuffle(seed);
            std::vector<std::uint32_t> order = first_to_last(keys.size());
            sort_by_depth(std::span<const std::uint32_t>(keys), order, scratch, SortThreads::All);
            CHECK(order == expected);
        }
    }
    set_task_shuffle(0);
    set_thread_count(before);
}

TEST_CASE("particle sort: keys ascend from far to near, NaN first, dead particles last") {
    const float inf = std::numeric_limits<float>::infinity();
    const float far_to_near[] = {std::nanf(""), inf, 1e30f,   100, 1.0000001f, 1,
                                 1e-40f,        0,   -1e-40f, -1,  -1e30f,     -inf};
    for (std::size_t i = 1; i < std::size(far_to_near); ++i) {
        CAPTURE(i);
        CHECK(depth_key(far_to_near[i - 1]) < depth_key(far_to_near[i]));
    }
    CHECK(depth_key(0.0f) == depth_key(-0.0f));
    CHECK(depth_key(-std::nanf("")) == 0);

    CHECK(depth_key16(std::nanf(""), 1, 100) == 0);
    CHECK(depth_key16(1000, 1, 100) == 1);
    CHECK(depth_key16(100, 1, 100) == 1);
    CHECK(depth_key16(1, 1, 100) == 65535);
    CHECK(depth_key16(-1000, 1, 100) == 65535);
    CHECK(depth_key16(50, 1, 100) < depth_key16(49.99f, 1, 100));
}

TEST_CASE("particle sort: particles are drawn from far to near, each once") {
    Random random(1, 2, 3, 4);
    std::vector<float> distance2(5000);
    std::vector<std::uint32_t> keys;
    for (float& d : distance2) {
        const Vec3 offset = {random.normal(), random.normal(), random.normal()};
        d = glm::dot(offset, offset);
        keys.push_back(depth_key(d));
    }
    SortScratch scratch;
    std::vector<std::uint32_t> order = first_to_last(keys.size());
    sort_by_depth(std::span<const std::uint32_t>(keys), order, scratch);
    std::vector<bool> drawn(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        CHECK(!drawn[order[i]]);
        drawn[order[i]] = true;
        if (i > 0) {
            CHECK(distance2[order[i - 1]] >= distance2[order[i]]);
        }
    }
}

TEST_CASE(
    "particle sort: three quads in sorted order blend as the farthest first does"
    * technique("particle.distance-sort")) {
    const float depth[] = {2, 9, 5};
    const float color[] = {0.2f, 1.0f, 0.6f};
    const float alpha[] = {0.5f, 0.25f, 0.75f};
    std::vector<std::uint32_t> keys;
    for (const float d : depth) {
        keys.push_back(depth_key(d));
    }
    std::vector<std::uint32_t> order = {0, 1, 2};
    SortScratch scratch;
    sort_by_depth(std::span<const std::uint32_t>(keys), order, scratch);
    float blended = 0;
    for (const std::uint32_t i : order) {
        blended = alpha[i] * color[i] + (1 - alpha[i]) * blended;
    }
    // 0.5 * 0.2 + 0.5 (0.75 * 0.6 + 0.25 (0.25 * 1))
    CHECK(std::abs(blended - 0.35625f) < 1e-6f);
}

TEST_CASE(
    "bitonic sort: passes and comparisons are those of the network"
    * technique("particle.bitonic-sort")) {
    const std::pair<std::size_t, std::uint32_t> passes[] = {
        {1, 0},     {2, 1},     {4, 3},       {8, 6},       {16, 10},
        {1024, 55}, {4096, 78}, {16384, 105}, {65536, 136}, {1048576, 210}};
    for (const auto& [count, expected] : passes) {
        CHECK(bitonic_pass_count(count) == expected);
    }
    // Half of the entries are compared with the others in each pass.
    CHECK(8 / 2 * bitonic_pass_count(8) == 24);
    CHECK(1024 / 2 * bitonic_pass_count(1024) == 28160);
    CHECK(std::size_t{1 << 19} * bitonic_pass_count(1 << 20) == 110100480);
    // Three stages of 1, 2 and 3 steps.
    const std::pair<int, int> steps[] = {{2, 1}, {4, 2}, {4, 1}, {8, 4}, {8, 2}, {8, 1}};
    for (std::uint32_t i = 0; i < 6; ++i) {
        const BitonicPass pass = bitonic_pass_at(i);
        CHECK(pass.run == steps[i].first);
        CHECK(pass.partner == steps[i].second);
    }
}

TEST_CASE(
    "bitonic sort: all permutations of eight are sorted" * technique("particle.bitonic-sort")) {
    std::vector<std::uint32_t> permutation = {0, 1, 2, 3, 4, 5, 6, 7};
    int permutations = 0;
    bool all_sorted = true;
    do {
        std::vector<std::uint32_t> entries = permutation;
        do_all_passes(entries);
        all_sorted = all_sorted && std::is_sorted(entries.begin(), entries.end());
        ++permutations;
    } while (std::next_permutation(permutation.begin(), permutation.end()));
    CHECK(permutations == 40320);
    CHECK(all_sorted);
}

TEST_CASE(
    "bitonic sort: all binary vectors of sixteen are sorted, and so is everything"
    * technique("particle.bitonic-sort")) {
    bool all_sorted = true;
    for (std::uint32_t bits = 0; bits < 1u << 16; ++bits) {
        std::vector<std::uint32_t> entries(16);
        for (std::uint32_t i = 0; i < 16; ++i) {
            entries[i] = (bits >> i) & 1u;
        }
        do_all_passes(entries);
        all_sorted = all_sorted && std::is_sorted(entries.begin(), entries.end());
    }
    CHECK(all_sorted);
}
