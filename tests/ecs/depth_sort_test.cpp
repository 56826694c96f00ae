#include "ecs/base/depth_sort.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"

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

/// Pairs that are drawn in the wrong order, as a share of all.
double inverted_share(const std::vector<std::uint32_t>& keys, std::vector<std::uint32_t> order) {
    double inversions = 0;
    const double pairs = 0.5 * static_cast<double>(order.size() * (order.size() - 1));
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t k = i + 1; k < order.size(); ++k) {
            inversions += keys[order[i]] > keys[order[k]] ? 1 : 0;
        }
    }
    return inversions / pairs;
}

}  // namespace

TEST_CASE("particle sort: 16-bit keys are sorted as by std::stable_sort") {
    check_equals_stable_sort<std::uint16_t>();
}

TEST_CASE("particle sort: 32-bit keys are sorted as by std::stable_sort") {
    check_equals_stable_sort<std::uint32_t>();
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

TEST_CASE("particle sort: keys ascend from far to near, NaN first, the dead last") {
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

TEST_CASE("particle sort: three quads in sorted order blend as the farthest first does") {
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

TEST_CASE("particle sort: an order keeps its entries when particles are born or die") {
    std::vector<std::uint32_t> order = {3, 0, 4, 1, 2};
    fit_order(order, 3);
    CHECK(order == std::vector<std::uint32_t>{0, 1, 2});
    order = {2, 0, 1};
    fit_order(order, 5);
    CHECK(order == std::vector<std::uint32_t>{2, 0, 1, 3, 4});
}

TEST_CASE("bitonic sort: passes and comparisons are those of the network") {
    const std::pair<std::size_t, std::uint32_t> passes[] = {
        {1, 0},     {2, 1},     {4, 3},       {8, 6},       {16, 10},
        {1024, 55}, {4096, 78}, {16384, 105}, {65536, 136}, {1048576, 210}};
    for (const auto& [count, expected] : passes) {
        CHECK(bitonic_pass_count(count) == expected);
    }
    std::vector<SortEntry> eight(8);
    CHECK(bitonic_sort(eight) == 24);
    std::vector<SortEntry> more(1024);
    CHECK(bitonic_sort(more) == 28160);
    CHECK(std::size_t{1 << 19} * bitonic_pass_count(1 << 20) == 110100480);
    // Three stages of 1, 2 and 3 steps.
    const std::pair<int, int> steps[] = {{2, 1}, {4, 2}, {4, 1}, {8, 4}, {8, 2}, {8, 1}};
    for (std::uint32_t i = 0; i < 6; ++i) {
        const BitonicPass pass = bitonic_pass_at(i);
        CHECK(pass.run == steps[i].first);
        CHECK(pass.partner == steps[i].second);
    }
}

TEST_CASE("bitonic sort: all permutations of eight come out sorted") {
    std::vector<SortEntry> permutation = {0, 1, 2, 3, 4, 5, 6, 7};
    int permutations = 0;
    bool all_sorted = true;
    do {
        std::vector<SortEntry> entries = permutation;
        bitonic_sort(entries);
        all_sorted = all_sorted && std::is_sorted(entries.begin(), entries.end());
        ++permutations;
    } while (std::next_permutation(permutation.begin(), permutation.end()));
    CHECK(permutations == 40320);
    CHECK(all_sorted);
}

TEST_CASE("bitonic sort: all binary vectors of sixteen come out sorted, so everything does") {
    bool all_sorted = true;
    for (std::uint32_t bits = 0; bits < 1u << 16; ++bits) {
        SortEntry entries[16];
        for (std::uint32_t i = 0; i < 16; ++i) {
            entries[i] = (bits >> i) & 1u;
        }
        bitonic_sort(entries);
        all_sorted = all_sorted && std::is_sorted(std::begin(entries), std::end(entries));
    }
    CHECK(all_sorted);
}

TEST_CASE("amortized sort: at four passes a frame a million particles take 53 frames") {
    const std::uint32_t passes = bitonic_pass_count(1 << 20);
    CHECK((passes + 3) / 4 == 53);
    CHECK((passes + 49) / 50 == 5);  // for 50 frames

    // 1000 particles are 55 passes: 14 frames at four.
    const std::vector<std::uint32_t> keys = random_keys<std::uint32_t>(1000, 600);
    AmortizedSort sort = {.passes_per_frame = 4};
    for (int frame = 1; frame < 14; ++frame) {
        CHECK(!step_amortized_sort(sort, keys));
        CHECK(sort.next_pass == 4 * static_cast<std::uint32_t>(frame));
        CHECK(sort.order == first_to_last(1000));
    }
    CHECK(step_amortized_sort(sort, keys));
    CHECK(sort.order == stable_order(keys, first_to_last(1000)));
}

TEST_CASE("amortized sort: keys are frozen while they are sorted") {
    const std::vector<std::uint32_t> keys = random_keys<std::uint32_t>(500, 65535);
    const std::vector<std::uint32_t> others(500, 1);
    AmortizedSort sort = {.passes_per_frame = 10};  // of 45
    CHECK(!step_amortized_sort(sort, keys));
    for (int frame = 0; frame < 3; ++frame) {
        CHECK(!step_amortized_sort(sort, others));
    }
    CHECK(step_amortized_sort(sort, others));
    CHECK(sort.order == stable_order(keys, first_to_last(500)));
}

TEST_CASE("amortized sort: the order holds each particle once while their number changes") {
    AmortizedSort sort = {.passes_per_frame = 7};
    Random random(5, 5, 5, 5);
    for (int frame = 0; frame < 300; ++frame) {
        const std::size_t count = random.below(200);
        step_amortized_sort(sort, random_keys<std::uint32_t>(count, 1000));
        std::vector<std::uint32_t> indices = sort.order;
        std::sort(indices.begin(), indices.end());
        CHECK(indices == first_to_last(count));
    }
}

TEST_CASE("amortized sort: behind a slow camera few pairs are out of order") {
    // 0.1 units per frame toward or past a cloud of 100 units, a sort of 55 frames. Sideways the
    // shown order is up to 109 frames old: 11 units or 4 degrees.
    for (const auto& [motion, limit] :
         {std::pair(Vec3(0, 0, -0.1f), 0.01), std::pair(Vec3(0.1f, 0, 0), 0.03)}) {
        Random random(9, 9, 9, 9);
        std::vector<Vec3> cloud(1024);
        for (Vec3& p : cloud) {
            p = 50.0f * std::cbrt(random.uniform()) * random.direction();
        }
        AmortizedSort sort = {.passes_per_frame = 1};
        Vec3 eye = {0, 0, 150};
        double worst = 0;
        for (int frame = 0; frame < 220; ++frame, eye += motion) {
            std::vector<std::uint32_t> keys;
            for (const Vec3& p : cloud) {
                keys.push_back(depth_key(glm::dot(p - eye, p - eye)));
            }
            step_amortized_sort(sort, keys);
            if (frame >= 54 && frame % 10 == 8) {
                worst = std::max(worst, inverted_share(keys, sort.order));
            }
        }
        MESSAGE("worst share of inverted pairs " << worst);
        CHECK(worst > 0);
        CHECK(worst < limit);
    }
}
