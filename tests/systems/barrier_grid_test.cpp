#include "ecs/base/rng.h"
#include "systems/crowd/barrier_grid.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace limn::barrier_grid_test {

namespace {

std::vector<CrowdBarrier> random_barriers(std::size_t count, float half, float size) {
    std::vector<CrowdBarrier> barriers;
    Random random(count, 0, 0, 0);
    for (std::size_t i = 0; i < count; ++i) {
        CrowdBarrier barrier;
        barrier.center.x = random.uniform(-half, half);
        barrier.center.y = random.uniform(-half, half);
        const float angle = random.uniform(0.0f, 6.0f);
        barrier.axis = {std::cos(angle), std::sin(angle)};
        if (i % 3 == 0) {
            barrier.radius = random.uniform(0.0f, size);
        } else {
            barrier.half.x = random.uniform(0.0f, size);
            barrier.half.y = random.uniform(0.0f, 1.0f);
        }
        barriers.push_back(barrier);
    }
    return barriers;
}

}  // namespace

TEST_CASE("barrier grid: lists all that comparing all finds, ascending, and each once") {
    Random random(1, 0, 0, 0);
    for (const float half : {5.0f, 100.0f, 1000.0f, 1e7f}) {
        std::vector<CrowdBarrier> barriers = random_barriers(60, half, 20);
        barriers.push_back({.center = {3, 3}, .axis = {0.6f, 0.8f}, .half = {5000, 0.1f}});
        BarrierGrid grid;
        update_barrier_grid(barriers, 1.5f, grid);
        std::size_t found = 0;
        for (int k = 0; k < 2000; ++k) {
            Vec2 point = barriers[random.below(60)].center;
            point.x += random.uniform(-25.0f, 25.0f);
            point.y += random.uniform(-25.0f, 25.0f);
            const std::span<const std::uint32_t> near = find_near_barriers(grid, point);
            REQUIRE(std::ranges::is_sorted(near, std::ranges::less_equal()));
            for (std::uint32_t i = 0; i < barriers.size(); ++i) {
                if (find_barrier(barriers[i], point).distance <= 1.5f) {
                    REQUIRE(std::ranges::binary_search(near, i));
                    ++found;
                }
            }
        }
        CHECK(found > 100);
    }
}

TEST_CASE("barrier grid: a walker among many walls looks at few") {
    for (const std::size_t count : {100u, 1000u, 10000u}) {
        const float half = 5 * std::sqrt(static_cast<float>(count));
        const std::vector<CrowdBarrier> barriers = random_barriers(count, half, 2);
        BarrierGrid grid;
        update_barrier_grid(barriers, 1, grid);
        std::size_t listed = 0;
        for (const CrowdBarrier& barrier : barriers) {
            listed += find_near_barriers(grid, barrier.center).size();
        }
        CHECK(listed < 4 * count);
    }
}

TEST_CASE("barrier grid: follows barriers that move, go, or are to be seen from farther") {
    std::vector<CrowdBarrier> barriers = {{.center = {2, 2}, .radius = 1}};
    BarrierGrid grid;
    CHECK(find_near_barriers(grid, {2, 2}).empty());
    update_barrier_grid(barriers, 1, grid);
    CHECK(find_near_barriers(grid, {2, 2}).size() == 1);
    CHECK(find_near_barriers(grid, {2, 14}).empty());
    update_barrier_grid(barriers, 20, grid);
    CHECK(find_near_barriers(grid, {2, 14}).size() == 1);
    barriers[0].center = {50, 50};
    update_barrier_grid(barriers, 1, grid);
    CHECK(find_near_barriers(grid, {2, 2}).empty());
    CHECK(find_near_barriers(grid, {50, 50}).size() == 1);
    update_barrier_grid({}, 1, grid);
    CHECK(find_near_barriers(grid, {50, 50}).empty());
}

}  // namespace limn::barrier_grid_test
