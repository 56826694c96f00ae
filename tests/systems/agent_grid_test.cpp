#include "ecs/base/rng.h"
#include "systems/crowd/agent_grid.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace limn::agent_grid_test {

namespace {

struct Points {
    std::vector<Vec2> points;
    std::vector<std::uint64_t> keys;
    AgentGrid grid;

    /// Half of them in clumps, some at the same point, some far away.
    explicit Points(std::size_t count, float cell) {
        Random random(count, 0, 0, 0);
        for (std::size_t i = 0; i < count; ++i) {
            const float half = i % 2 == 0 ? 30.0f : i % 5 == 0 ? 1e7f : 2.0f;
            Vec2 point;
            point.x = random.uniform(-half, half);
            point.y = random.uniform(-half, half);
            points.push_back(i % 7 == 3 ? points[i / 2] : point);
            keys.push_back(i * 31 % 1009);
        }
        build_agent_grid(points, keys, cell, grid);
    }
    std::vector<std::uint64_t> within(const Vec2& center, float reach) const {
        std::vector<std::uint64_t> found;
        std::vector<int> visits(points.size(), 0);
        each_run(grid, center, reach, [&](SlotRun run) {
            for (std::uint32_t slot = run.begin; slot < run.end; ++slot) {
                ++visits[slot];
                if (glm::distance(points[grid.order[slot]], center) <= reach) {
                    found.push_back(keys[grid.order[slot]]);
                }
            }
        });
        CHECK(std::ranges::count_if(visits, [](int n) { return n > 1; }) == 0);
        return found;
    }
};

}  // namespace

TEST_CASE("agent grid: finds the neighbors that comparing all finds, each once") {
    for (const std::size_t count : {1u, 5u, 17u, 200u, 1000u}) {
        const Points all(count, 2);
        for (std::size_t i = 0; i < count; i += 1 + count / 40) {
            for (const float reach : {0.0f, 0.5f, 5.0f, 100.0f}) {
                std::vector<std::uint64_t> found = all.within(all.points[i], reach);
                std::vector<std::uint64_t> expected;
                for (std::size_t j = 0; j < count; ++j) {
                    if (glm::distance(all.points[j], all.points[i]) <= reach) {
                        expected.push_back(all.keys[j]);
                    }
                }
                std::ranges::sort(found);
                std::ranges::sort(expected);
                REQUIRE(found == expected);
            }
        }
    }
}

TEST_CASE("agent grid: the order depends on the set of points alone") {
    Points all(500, 1.5f);
    std::vector<std::uint64_t> expected;
    for (const std::uint32_t i : all.grid.order) {
        expected.push_back(all.keys[i]);
    }
    std::ranges::reverse(all.points);
    std::ranges::reverse(all.keys);
    build_agent_grid(all.points, all.keys, 1.5f, all.grid);
    for (std::size_t slot = 0; slot < expected.size(); ++slot) {
        REQUIRE(all.keys[all.grid.order[slot]] == expected[slot]);
    }
}

TEST_CASE("agent grid: without points nothing is found") {
    AgentGrid grid;
    build_agent_grid({}, {}, 1, grid);
    each_run(grid, {0, 0}, 10, [](SlotRun run) { CHECK(run.begin == run.end); });
}

}  // namespace limn::agent_grid_test
