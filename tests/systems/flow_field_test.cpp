#include "systems/crowd/flow_field.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace limn::flow_field_test {

namespace {

CrowdBarrier box(const Vec2& center, const Vec2& size) {
    return {.center = center, .half = 0.5f * size};
}

/// Walks along the field in small steps: the length of the way; -1 where it does not arrive.
float walk(const FlowGrid& grid, const FlowField& field, Vec2 point, const Vec2& goal) {
    constexpr float kStep = 0.05f;
    for (int i = 0; i < 4000; ++i) {
        if (glm::distance(point, goal) < 0.6f) {
            return kStep * static_cast<float>(i) + glm::distance(point, goal);
        }
        point += kStep * find_flow(grid, field, point);
    }
    return -1;
}

}  // namespace

TEST_CASE("flow field: on open ground ways are straight") {
    const FlowGrid grid = make_flow_grid({3, -2}, {20, 30}, 0.5f, 0.4f, {});
    CHECK(grid.columns == 40);
    CHECK(grid.rows == 60);
    const Vec2 goal = {5, 4};
    const FlowField field = solve_flow_field(grid, goal, 1);
    CHECK(!field.moved);
    for (const Vec2& point : {Vec2(-6, -16), Vec2(12, 12), Vec2(-5, 4), Vec2(5, -14)}) {
        const Vec2 way = find_flow(grid, field, point);
        CHECK(glm::dot(way, glm::normalize(goal - point)) > 0.99f);
        CHECK(
            walk(grid, field, point, goal) == test::near(glm::distance(point, goal)).epsilon(0.02));
    }
    CHECK(find_flow(grid, field, {100, 0}) == Vec2(0));
    CHECK(find_flow(grid, field, {NAN, 0}) == Vec2(0));
}

TEST_CASE("flow field: the way around a wall is as long as over its corner") {
    const std::vector<CrowdBarrier> wall = {box({0, 0}, {1, 16})};
    const FlowGrid grid = make_flow_grid({0, 0}, {30, 30}, 0.25f, 0.4f, wall);
    const Vec2 goal = {8, 0};
    const FlowField field = solve_flow_field(grid, goal, 0.5f);
    const Vec2 start = {-8, 1};  // over the upper corners of the wall, 0.4 m away
    const float expected =
        glm::distance(start, {-0.9f, 8.4f}) + 1.8f + glm::distance(goal, {0.9f, 8.4f});
    CHECK(walk(grid, field, start, goal) == test::near(expected).epsilon(0.05));
}

TEST_CASE(
    "flow field: a goal within an obstacle is the nearest free cell; no way is no direction") {
    const std::vector<CrowdBarrier> barriers = {box({5, 0}, {4, 4})};
    const FlowGrid grid = make_flow_grid({0, 0}, {20, 20}, 0.5f, 0.3f, barriers);
    const FlowField field = solve_flow_field(grid, {4.5f, 0}, 0.5f);
    CHECK(field.moved);
    CHECK(walk(grid, field, {-5, 0.5f}, {2.5f, 0.1f}) > 0);

    // Walled in on all sides.
    const std::vector<CrowdBarrier> cell = {
        box({-3, 0}, {1, 8}), box({3, 0}, {1, 8}), box({0, -3}, {8, 1}), box({0, 3}, {8, 1})};
    const FlowGrid closed = make_flow_grid({0, 0}, {20, 20}, 0.5f, 0.1f, cell);
    const FlowField inner = solve_flow_field(closed, {0, 0}, 0.5f);
    CHECK(find_flow(closed, inner, {-8, 8}) == Vec2(0));
    CHECK(find_flow(closed, inner, {1.5f, 1}) != Vec2(0));

    const std::vector<CrowdBarrier> everywhere = {box({0, 0}, {100, 100})};
    const FlowGrid full = make_flow_grid({0, 0}, {20, 20}, 0.5f, 0.1f, everywhere);
    const FlowField none = solve_flow_field(full, {0, 0}, 0.5f);
    CHECK(none.moved);
    CHECK(find_flow(full, none, {1, 1}) == Vec2(0));
}

TEST_CASE("flow field: huge spaces have a thousand cells along a side") {
    const FlowGrid grid = make_flow_grid({0, 0}, {10000, 10}, 0.5f, 0.4f, {});
    CHECK(grid.columns == 1000);
    CHECK(grid.rows == 2);
    CHECK(grid.cell == 10);
}

TEST_CASE("barrier: distances to rotated boxes and discs, outside and inside") {
    CrowdBarrier turned = box({2, 1}, {4, 2});
    turned.axis = {0.6f, 0.8f};
    const Vec2 side = {-0.8f, 0.6f};
    for (const float out : {0.5f, -0.5f}) {  // beyond the second side, and within
        const BarrierHit hit = find_barrier(turned, turned.center + (1 + out) * side);
        CHECK(hit.distance == test::near(out));
        CHECK(glm::distance(hit.toward, -side) < 1e-6f);
    }
    const Vec2 corner = turned.center + 2.0f * turned.axis + side;
    const BarrierHit hit = find_barrier(turned, corner + 0.3f * turned.axis + 0.4f * side);
    CHECK(hit.distance == test::near(0.5));
    const CrowdBarrier disc = {.center = {1, 1}, .radius = 0.5f};
    CHECK(find_barrier(disc, {3, 1}).distance == test::near(1.5));
    CHECK(find_barrier(disc, {1, 1}).distance == test::near(-0.5));
    CHECK(glm::length(find_barrier(disc, {1, 1}).toward) == test::near(1));
}

}  // namespace limn::flow_field_test
