#include "bench/oracles/crowd_oracle.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/crowd/step_crowd.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace limn::step_crowd_test {

namespace {

constexpr float kStep = 1.0f / 60;

/// Walkers and where they go.
struct Crowd {
    std::vector<CrowdWalker> walkers;
    std::vector<Vec2> goals;
    std::vector<CrowdBarrier> barriers;
    WalkerScratch scratch;
    std::uint64_t frame = 0;

    void add(const Vec2& position, const Vec2& goal, float side = 1, float radius = 0.3f) {
        CrowdWalker walker;
        walker.position = position;
        walker.radius = radius;
        walker.max_speed = 1.8f;
        walker.side = side;
        walker.key = walkers.size() + 1;
        walkers.push_back(walker);
        goals.push_back(goal);
    }
    void step(float dt = kStep) {
        for (CrowdWalker& walker : walkers) {
            const Vec2 offset = goals[walker.key - 1] - walker.position;
            const float distance = glm::length(offset);
            walker.wanted =
                distance < 0.3f ? Vec2(0) : offset * (std::min(1.3f, 2 * distance) / distance);
            walker.distance = distance;
            walker.wanted = jittered_velocity(walker, 1, frame);
        }
        ++frame;
        step_crowd(walkers, barriers, dt, scratch);
    }
    /// Pairs that overlap by more than a millimeter.
    std::size_t overlaps() const {
        std::vector<oracle::CrowdVec> centers;
        std::vector<double> radii;
        for (const CrowdWalker& walker : walkers) {
            centers.push_back({double(walker.position.x), double(walker.position.y)});
            radii.push_back(double(walker.radius));
        }
        return oracle::count_overlaps(centers, radii, 1e-3).first;
    }
    bool arrived() const {
        return std::ranges::all_of(walkers, [&](const CrowdWalker& walker) {
            return glm::distance(walker.position, goals[walker.key - 1]) < 1;
        });
    }
};

Crowd make_ring(int count, float radius) {
    Crowd crowd;
    for (int i = 0; i < count; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(count);
        const Vec2 start = radius * Vec2(std::cos(angle), std::sin(angle));
        crowd.add(start, -start);
    }
    return crowd;
}

/// Random walkers, without overlaps, with goals anywhere.
Crowd make_mixed(std::size_t count, float density, std::uint64_t seed) {
    Crowd crowd;
    Random random(seed, 0, 0, 0);
    const float side = std::sqrt(static_cast<float>(count) / density);
    const auto point = [&] {
        Vec2 p;
        p.x = random.uniform(0.0f, side);
        p.y = random.uniform(0.0f, side);
        return p;
    };
    while (crowd.walkers.size() < count) {
        const Vec2 start = point();
        const float radius = random.uniform(0.2f, 0.35f);
        const bool is_free = std::ranges::none_of(crowd.walkers, [&](const CrowdWalker& other) {
            return glm::distance(other.position, start) < other.radius + radius + 0.01f;
        });
        if (is_free) {
            const Vec2 goal = point();
            crowd.add(start, goal, 1, radius);
        }
    }
    return crowd;
}

bool same_bits(const CrowdWalker& a, const CrowdWalker& b) {
    return a.key == b.key && std::memcmp(&a.position, &b.position, sizeof(Vec2)) == 0
           && std::memcmp(&a.velocity, &b.velocity, sizeof(Vec2)) == 0 && a.detour == b.detour;
}

}  // namespace

TEST_CASE(
    "crowd: two walkers head-on pass on the side they prefer, without touching"
    * technique("char.flock")) {
    for (const float side : {1.0f, -1.0f}) {
        Crowd crowd;
        crowd.add({-6, 0}, {6, 0}, side);
        crowd.add({6, 0}, {-6, 0}, side);
        float passed = 0;
        for (int i = 0; i < 900 && !crowd.arrived(); ++i) {
            crowd.step();
            CHECK(crowd.overlaps() == 0);
            if (std::abs(crowd.walkers[0].position.x) < 0.1f) {
                passed = crowd.walkers[0].position.y;
            }
        }
        CHECK(crowd.arrived());
        // Counterclockwise from +x is +y.
        CHECK(passed * side > 0.1f);
    }
}

TEST_CASE(
    "crowd: nobody overlaps, and all arrive: random goals, and rings that meet in the center"
    * technique("char.flock")) {
    Crowd mixed = make_mixed(300, 1, 5);
    for (int i = 0; i < 600; ++i) {
        mixed.step();
        if (i % 10 == 0) {
            REQUIRE(mixed.overlaps() == 0);
        }
    }
    Crowd ring = make_ring(40, 6.4f);
    const float straight = 2 * 6.4f / 1.3f;
    int steps = 0;
    for (; steps < 2400 && !ring.arrived(); ++steps) {
        ring.step();
        REQUIRE(ring.overlaps() == 0);
    }
    CHECK(ring.arrived());
    // When all are there at once, of whom some had to make way again: 1.3 to 2.4 with other seeds.
    CHECK(static_cast<float>(steps) * kStep < 2.5f * straight);
}

TEST_CASE("crowd: who stands makes way, and comes back") {
    Crowd crowd;
    crowd.add({-4, 0}, {4, 0});
    for (int i = -1; i <= 1; ++i) {
        const Vec2 place = {0, 0.65f * static_cast<float>(i)};
        crowd.add(place, place);
    }
    for (int i = 0; i < 900; ++i) {
        crowd.step();
        REQUIRE(crowd.overlaps() == 0);
    }
    CHECK(crowd.arrived());
    CHECK(crowd.walkers[0].detour == 0);
}

TEST_CASE("crowd: the order of the walkers changes nothing" * technique("char.flock")) {
    Crowd crowd = make_mixed(200, 1, 9);
    Crowd shuffled = crowd;
    for (std::size_t i = 0; i < shuffled.walkers.size(); ++i) {
        std::swap(shuffled.walkers[i], shuffled.walkers[i * 7919 % shuffled.walkers.size()]);
    }
    for (int i = 0; i < 120; ++i) {
        crowd.step();
        shuffled.step();
    }
    const auto by_key = [](const CrowdWalker& a, const CrowdWalker& b) { return a.key < b.key; };
    std::ranges::sort(shuffled.walkers, by_key);
    for (std::size_t i = 0; i < crowd.walkers.size(); ++i) {
        REQUIRE(same_bits(crowd.walkers[i], shuffled.walkers[i]));
    }
}

TEST_CASE("crowd: the same bits on 1, 2, 3 and 7 threads") {
    const auto run = [](int threads) {
        set_thread_count(threads);
        Crowd crowd = make_mixed(1500, 1, 3);
        for (int i = 0; i < 30; ++i) {
            crowd.step();
        }
        set_thread_count(0);
        return crowd.walkers;
    };
    const std::vector<CrowdWalker> expected = run(1);
    for (const int threads : {2, 3, 7}) {
        const std::vector<CrowdWalker> found = run(threads);
        CHECK(std::ranges::equal(found, expected, same_bits));
    }
}

TEST_CASE("crowd: coincident walkers part; nobody is faster than the maximum; all is finite") {
    Crowd crowd;
    for (int i = 0; i < 20; ++i) {
        crowd.add({1, 1}, {1, 1});
    }
    for (int i = 0; i < 300; ++i) {
        crowd.step();
        for (const CrowdWalker& walker : crowd.walkers) {
            REQUIRE(is_finite(walker.position));
            REQUIRE(glm::length(walker.velocity) <= 1.8f + 1e-4f);
        }
    }
    CHECK(crowd.overlaps() == 0);
}

TEST_CASE("crowd: obstacles are walked around and never entered, alone and in a crowd") {
    for (const int count : {1, 16}) {
        Crowd crowd;
        crowd.barriers = {{.center = {0, 0}, .radius = 1}, {.center = {0, 4}, .half = {0.5f, 1}}};
        for (int i = 0; i < count; ++i) {
            const float side = i % 2 == 0 ? 1.0f : -1.0f;
            const float place = side * (6 + 0.4f * static_cast<float>(i));
            crowd.add({-place, 0.05f}, {place, 0.05f});
        }
        for (int i = 0; i < 1200; ++i) {
            crowd.step();
            for (const CrowdWalker& walker : crowd.walkers) {
                for (const CrowdBarrier& barrier : crowd.barriers) {
                    REQUIRE(
                        find_barrier(barrier, walker.position).distance > walker.radius - 1e-3f);
                }
            }
        }
        if (count == 1) {
            CHECK(crowd.arrived());
        }
    }
}

TEST_CASE("crowd: no walkers, no time, no speed, and a step of a second") {
    Crowd crowd;
    crowd.step();
    crowd.add({0, 0}, {5, 0});
    crowd.add({1, 0}, {-5, 0});
    const std::vector<CrowdWalker> before = crowd.walkers;
    crowd.step(0);
    CHECK(crowd.walkers[0].position == before[0].position);
    crowd.walkers[1].max_speed = 0;
    for (int i = 0; i < 30; ++i) {
        crowd.step(1);
        CHECK(crowd.overlaps() == 0);
    }
    CHECK(glm::distance(crowd.walkers[0].position, crowd.goals[0]) < 1);
    CHECK(glm::distance(crowd.walkers[1].position, before[1].position) < 1);
}

TEST_CASE("crowd: who is inside a wall comes out, also in the middle and where two cross") {
    for (const float dt : {kStep, 1.0f}) {
        Crowd crowd;
        crowd.barriers = {
            {.center = {0, 0}, .half = {3, 0.5f}},
            {.center = {3, 0}, .half = {0.5f, 3}},
            {.center = {-8, 0}, .radius = 1}};
        for (const Vec2& place : {Vec2(0, 0), Vec2(3, 0), Vec2(2.9f, 0.2f), Vec2(-8, 0)}) {
            crowd.add(place, {20, 0});
        }
        for (int i = 0; i < 240; ++i) {
            crowd.step(dt);
            for (const CrowdWalker& walker : crowd.walkers) {
                REQUIRE(is_finite(walker.position));
            }
        }
        for (const CrowdWalker& walker : crowd.walkers) {
            for (const CrowdBarrier& barrier : crowd.barriers) {
                CHECK(find_barrier(barrier, walker.position).distance > walker.radius - 2e-3f);
            }
        }
    }
}

TEST_CASE("crowd: a step of a second does not pass a wall, however thin") {
    Crowd crowd;
    crowd.barriers = {{.center = {0, 0}, .half = {0.001f, 50}}};
    for (int i = 0; i < 12; ++i) {
        const auto k = static_cast<float>(i);
        crowd.add({-4 - 0.1f * k, k}, {4, k});
    }
    for (int i = 0; i < 40; ++i) {
        crowd.step(1);
        for (const CrowdWalker& walker : crowd.walkers) {
            REQUIRE(walker.position.x < 0);
        }
    }
}

TEST_CASE("crowd: walkers of radius 0 walk, alone, at one place, and through a throng") {
    Crowd crowd;
    crowd.add({0, 0}, {8, 0}, 1, 0);
    crowd.add({0, 0}, {8, 0}, 1, 0);
    for (int i = 0; i < 5; ++i) {
        crowd.add({4, static_cast<float>(i) - 2}, {4, static_cast<float>(i) - 2});
    }
    for (int i = 0; i < 900; ++i) {
        crowd.step();
        for (const CrowdWalker& walker : crowd.walkers) {
            REQUIRE(is_finite(walker.position + walker.velocity));
        }
    }
    CHECK(crowd.arrived());
    CHECK(crowd.overlaps() == 0);
}

TEST_CASE("crowd: of two walkers the one with priority evades less") {
    Crowd crowd;
    crowd.add({-5, 0.05f}, {5, 0.05f});
    crowd.add({5, 0}, {-5, 0});
    crowd.walkers[0].priority = 20;
    float first = 0;
    float second = 0;
    for (int i = 0; i < 600; ++i) {
        crowd.step();
        first = std::max(first, std::abs(crowd.walkers[0].position.y - 0.05f));
        second = std::max(second, std::abs(crowd.walkers[1].position.y));
    }
    CHECK(crowd.arrived());
    CHECK(first < 0.2f * second);
}

}  // namespace limn::step_crowd_test
