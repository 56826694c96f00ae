#include "bench/oracles/crowd_oracle.h"
#include "ecs/base/rng.h"
#include "systems/crowd/orca.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::orca_test {

using oracle::CrowdHalfPlane;
using oracle::CrowdVec;

namespace {

Vec2 in_square(Random& random, float half) {
    Vec2 point;
    point.x = random.uniform(-half, half);
    point.y = random.uniform(-half, half);
    return point;
}

Vec2 unit(Random& random) {
    const float angle = random.uniform(0.0f, 2 * kPi);
    return {std::cos(angle), std::sin(angle)};
}

CrowdVec exact(const Vec2& v) {
    return {double(v.x), double(v.y)};
}

std::vector<CrowdHalfPlane> exact(const std::vector<VelocityPlane>& planes) {
    std::vector<CrowdHalfPlane> result;
    for (const VelocityPlane& plane : planes) {
        CrowdVec normal = exact(plane.normal);
        normal = (1 / oracle::length_of(normal)) * normal;
        result.push_back({double(plane.offset) * normal, normal});
    }
    return result;
}

std::vector<VelocityPlane> random_planes(Random& random, std::size_t count, float reach) {
    std::vector<VelocityPlane> planes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 point = in_square(random, reach);
        const Vec2 normal = unit(random);
        planes.push_back({normal, glm::dot(normal, point)});
    }
    return planes;
}

}  // namespace

TEST_CASE(
    "ORCA: the optimum of 10,000 random programs is as near as brute force over all corners"
    * technique("char.flock")) {
    Random random(1, 0, 0, 0);
    int feasible = 0;
    for (int i = 0; i < 10000; ++i) {
        const std::vector<VelocityPlane> planes = random_planes(random, 1 + random.below(10), 1.5f);
        const Vec2 preferred = in_square(random, 2);
        const Vec2 v = solve_velocity(planes, 0, preferred, 1.5f);
        const double best = oracle::best_distance(exact(planes), exact(preferred), 1.5, 1e-9);
        CHECK(glm::length(v) <= 1.5f + 1e-5f);
        if (std::isfinite(best)) {
            ++feasible;
            // Where lines are nearly parallel, an error of v of 1e-4 is one of the rounding.
            REQUIRE(oracle::largest_excess(exact(planes), exact(v)) < 2e-4);
            REQUIRE(glm::distance(v, preferred) == test::near(best).epsilon(2e-3).scale(1));
        }
    }
    CHECK(feasible > 2000);
    CHECK(feasible < 9000);
}

TEST_CASE(
    "ORCA: where no velocity meets all half-planes, the largest excess is the least"
    * technique("char.flock")) {
    Random random(2, 0, 0, 0);
    int infeasible = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::vector<VelocityPlane> planes = random_planes(random, 3 + random.below(8), 1.5f);
        const Vec2 v = solve_velocity(planes, 0, {1, 0}, 1.5f);
        const double least = oracle::least_excess(exact(planes), 1.5);
        if (least > 0.01) {
            ++infeasible;
            REQUIRE(oracle::largest_excess(exact(planes), exact(v)) < least + 5e-3);
        }
    }
    CHECK(infeasible > 100);
}

TEST_CASE("ORCA: hard half-planes are met where those of walkers cannot all be") {
    Random random(3, 0, 0, 0);
    for (int i = 0; i < 2000; ++i) {
        std::vector<VelocityPlane> planes = {{{-1, 0}, -0.2f}, {{0, 1}, 0.3f}};
        const std::vector<VelocityPlane> more = random_planes(random, 6, 1.5f);
        planes.insert(planes.end(), more.begin(), more.end());
        const Vec2 v = solve_velocity(planes, 2, in_square(random, 1), 1.5f);
        REQUIRE(v.x <= 0.2f + 1e-4f);
        REQUIRE(v.y >= 0.3f - 1e-4f);
    }
}

TEST_CASE(
    "ORCA: two walkers that both take their half do not touch within the horizon"
    * technique("char.flock")) {
    Random random(4, 0, 0, 0);
    int evaded = 0;
    for (int i = 0; i < 2000; ++i) {
        WalkerDisc a = {{0, 0}, in_square(random, 1.5f), 0.3f};
        WalkerDisc b = {in_square(random, 4), in_square(random, 1.5f), 0.4f};
        if (glm::length(b.position) < 0.75f) {
            continue;
        }
        const float share = random.uniform(0.0f, 1.0f);
        const VelocityPlane for_a = avoid_walker(a, b, {.horizon = 2, .share = share});
        const VelocityPlane for_b = avoid_walker(b, a, {.horizon = 2, .share = 1 - share});
        const Vec2 va = solve_velocity({&for_a, 1}, 0, a.velocity, 100);
        const Vec2 vb = solve_velocity({&for_b, 1}, 0, b.velocity, 100);
        const CrowdVec offset = exact(b.position);
        const bool collides = oracle::discs_collide(offset, exact(a.velocity - b.velocity), 0.7, 2);
        CHECK(!oracle::discs_collide(offset, exact(va - vb), 0.7 - 1e-3, 2));
        // Who is on no collision course keeps the velocity.
        if (collides) {
            ++evaded;
            CHECK(glm::distance(va, a.velocity) + glm::distance(vb, b.velocity) > 0);
        } else {
            CHECK(glm::distance(va, a.velocity) < 1e-4f);
        }
    }
    CHECK(evaded > 100);
}

TEST_CASE("ORCA: coincident walkers part, and overlapping ones within the contact time") {
    const WalkerDisc same = {{1, 2}, {0, 0}, 0.3f};
    const VelocityPlane first = avoid_walker(same, same, {.apart = {0.6f, 0.8f}});
    const VelocityPlane second = avoid_walker(same, same, {.apart = {-0.6f, -0.8f}});
    const Vec2 va = solve_velocity({&first, 1}, 0, {0, 0}, 10);
    const Vec2 vb = solve_velocity({&second, 1}, 0, {0, 0}, 10);
    CHECK(glm::length(va - vb) * 0.2f == test::near(0.6));
    CHECK(glm::dot(va - vb, Vec2(0.6f, 0.8f)) * 0.2f == test::near(0.6));
}

TEST_CASE("ORCA: no plane, speed 0 and parallel planes") {
    CHECK(solve_velocity({}, 0, {3, 4}, 1) == Vec2(0.6f, 0.8f));
    CHECK(solve_velocity({}, 0, {0.3f, 0.4f}, 1) == Vec2(0.3f, 0.4f));
    const VelocityPlane wall = avoid_wall({1, 0}, 0.1f, 0.5f);
    CHECK(glm::distance(solve_velocity({&wall, 1}, 1, {1, 0.3f}, 2), Vec2(0.2f, 0.3f)) < 1e-6f);
    CHECK(solve_velocity({&wall, 1}, 1, {1, 0}, 0) == Vec2(0));
    const VelocityPlane opposed[] = {{{1, 0}, 0.5f}, {{-1, 0}, 0.5f}};
    CHECK(std::abs(solve_velocity(opposed, 0, {0.2f, 0}, 2).x) < 1e-5f);
}

}  // namespace limn::orca_test
