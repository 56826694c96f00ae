#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/crowd/flock_rules.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstring>
#include <vector>

namespace limn::flock_test {

namespace {

constexpr float kStep = 1.0f / 60;

/// Only the rules with a weight act; nothing else limits.
FlockParams only(float avoid, float match, float center) {
    return {
        .radius = 100,
        .separation = 100,
        .avoid = avoid,
        .match = match,
        .center = center,
        .wander = 0,
        .max_acceleration = 1000,
        .min_speed = 0,
        .max_speed = 1000};
}

std::vector<FlockMember> make_boids(std::size_t count, float half, std::uint64_t seed) {
    Random random(seed, 0, 0, 0);
    std::vector<FlockMember> boids(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            boids[i].position[axis] = random.uniform(-half, half);
            boids[i].velocity[axis] = random.uniform(-2.0f, 2.0f);
        }
        boids[i].key = i + 1;
    }
    return boids;
}

void run(const FlockParams& params, std::vector<FlockMember>& boids, int steps) {
    FlockScratch scratch;
    for (int i = 0; i < steps; ++i) {
        step_flock(params, Vec3(0), {}, kStep, boids, scratch);
    }
}

Vec3 mean_velocity(const std::vector<FlockMember>& boids) {
    Vec3 sum(0);
    for (const FlockMember& boid : boids) {
        sum += boid.velocity;
    }
    return sum / static_cast<float>(boids.size());
}

float bounding_radius(const std::vector<FlockMember>& boids) {
    Vec3 center(0);
    for (const FlockMember& boid : boids) {
        center += boid.position / static_cast<float>(boids.size());
    }
    float radius = 0;
    for (const FlockMember& boid : boids) {
        radius = std::max(radius, glm::distance(boid.position, center));
    }
    return radius;
}

bool same_bits(const FlockMember& a, const FlockMember& b) {
    return a.key == b.key && std::memcmp(&a.position, &b.position, sizeof(Vec3)) == 0
           && std::memcmp(&a.velocity, &b.velocity, sizeof(Vec3)) == 0;
}

}  // namespace

TEST_CASE(
    "flock: rules take precedence until the acceleration is spent" * technique("char.flock")) {
    const FlockRules rules = {Vec3(3, 0, 0), Vec3(0, 4, 0), Vec3(0, 0, 5), Vec3(1, 1, 1)};
    CHECK(allocate_acceleration(rules, 2) == Vec3(2, 0, 0));  // a1 alone, truncated
    CHECK(allocate_acceleration(rules, 3) == Vec3(3, 0, 0));
    CHECK(allocate_acceleration(rules, 5) == Vec3(3, 2, 0));
    CHECK(allocate_acceleration(rules, 100) == Vec3(4, 5, 6));
    CHECK(allocate_acceleration(rules, 0) == Vec3(0));
    CHECK(allocate_acceleration({}, 0) == Vec3(0));

    // In a flock: where the first rule spends all, the weights of the others change nothing.
    FlockParams params = only(1, 0, 0);
    params.max_acceleration = 0.01f;
    std::vector<FlockMember> alone = make_boids(30, 5, 1);
    std::vector<FlockMember> all = alone;
    run(params, alone, 1);
    params.match = 3;
    params.center = 2;
    params.wander = 1;
    run(params, all, 1);
    CHECK(std::ranges::equal(alone, all, same_bits));
}

TEST_CASE("flock: the rules of two boids by hand" * technique("char.flock")) {
    const std::vector<FlockMember> boids = {
        {.position = {0, 0, 0}, .velocity = {1, 0, 0}, .key = 1},
        {.position = {0, 0, 2}, .velocity = {0, 3, 0}, .key = 2}};
    FlockScratch scratch;
    const FlockParams params = only(4, 2, 0.5f);
    arrange_flock(params, boids, scratch);
    const std::size_t slot = scratch.slots[0].key == 1 ? 0 : 1;
    const FlockRules rules = find_flock_rules(params, Vec3(0), {}, scratch, slot);
    CHECK(glm::distance(rules[0], Vec3(0, 0, -2)) < 1e-6f);  // 4 (0 - 2) / 2^2
    CHECK(glm::distance(rules[1], Vec3(-2, 6, 0)) < 1e-6f);
    CHECK(glm::distance(rules[2], Vec3(0, 0, 1)) < 1e-6f);
    // Beside the heading: not within a cone of view of 80 degrees.
    FlockParams narrow = params;
    narrow.view = radians(80);
    const FlockRules blind = find_flock_rules(narrow, Vec3(0), {}, scratch, slot);
    CHECK(blind[0] == Vec3(0));
    CHECK(blind[1] == Vec3(0));
}

TEST_CASE(
    "flock: two boids within the separation part, coincident ones too" * technique("char.flock")) {
    for (const float distance : {0.5f, 0.0f}) {
        std::vector<FlockMember> boids = {
            {.position = {0, 1, 0}, .key = 1}, {.position = {distance, 1, 0}, .key = 2}};
        FlockParams params = only(1, 0, 0);
        params.max_acceleration = 5;
        float last = distance;
        for (int i = 0; i < 60; ++i) {
            run(params, boids, 1);
            const float now = glm::distance(boids[0].position, boids[1].position);
            CHECK(now > last);
            last = now;
        }
    }
}

TEST_CASE(
    "flock: with matching alone all take on the mean velocity, and it is conserved"
    * technique("char.flock")) {
    std::vector<FlockMember> boids = make_boids(40, 3, 2);
    const Vec3 mean = mean_velocity(boids);
    run(only(0, 1, 0), boids, 600);
    CHECK(glm::distance(mean_velocity(boids), mean) < 1e-4f);
    for (const FlockMember& boid : boids) {
        CHECK(glm::distance(boid.velocity, mean) < 1e-3f);
    }
}

TEST_CASE("flock: with centering alone a flock at rest does not grow" * technique("char.flock")) {
    std::vector<FlockMember> boids = make_boids(40, 5, 3);
    for (FlockMember& boid : boids) {
        boid.velocity = Vec3(0);
    }
    const float radius = bounding_radius(boids);
    float smallest = radius;
    for (int i = 0; i < 400; ++i) {
        run(only(0, 0, 1), boids, 1);
        CHECK(bounding_radius(boids) <= radius * (1 + 1e-4f));
        smallest = std::min(smallest, bounding_radius(boids));
    }
    CHECK(smallest < 0.5f * radius);
}

TEST_CASE(
    "flock: the order of boids and the number of threads change nothing"
    * technique("char.flock")) {
    const FlockParams params;
    std::vector<FlockMember> boids = make_boids(700, 12, 4);
    std::vector<FlockMember> shuffled = boids;
    for (std::size_t i = 0; i < shuffled.size(); ++i) {
        std::swap(shuffled[i], shuffled[i * 7919 % shuffled.size()]);
    }
    const std::vector<FlockMember> start = boids;
    run(params, boids, 60);
    run(params, shuffled, 60);
    std::ranges::sort(shuffled, {}, &FlockMember::key);
    CHECK(std::ranges::equal(boids, shuffled, same_bits));
    for (const int threads : {1, 2, 3, 7}) {
        set_thread_count(threads);
        std::vector<FlockMember> again = start;
        run(params, again, 60);
        set_thread_count(0);
        CHECK(std::ranges::equal(boids, again, same_bits));
    }
}

TEST_CASE("flock: speeds stay within their limits, and the flock near its home") {
    FlockParams params;
    params.home_radius = 8;
    params.wander = 2;
    std::vector<FlockMember> boids = make_boids(100, 5, 5);
    for (int i = 0; i < 1200; ++i) {
        run(params, boids, 1);
        for (const FlockMember& boid : boids) {
            const float speed = glm::length(boid.velocity);
            REQUIRE(speed >= params.min_speed * (1 - 1e-5f));
            REQUIRE(speed <= params.max_speed * (1 + 1e-5f));
        }
    }
    CHECK(bounding_radius(boids) < 25);
}

TEST_CASE("flock: a herd keeps its height and keeps off obstacles") {
    FlockParams params = only(2, 0.5f, 0.1f);
    params.planar = true;
    params.separation = 1;
    params.max_speed = 1;
    params.max_acceleration = 20;
    std::vector<FlockMember> boids = make_boids(20, 6, 6);
    for (FlockMember& boid : boids) {
        boid.position.y = 0.25f;
        boid.position.x -= 10;
        boid.velocity = {1, 0, 0};
    }
    const CrowdBarrier rock = {.center = {0, 0}, .radius = 2};
    FlockScratch scratch;
    for (int i = 0; i < 1200; ++i) {
        step_flock(params, Vec3(0), {&rock, 1}, kStep, boids, scratch);
        for (const FlockMember& boid : boids) {
            REQUIRE(boid.position.y == 0.25f);
            REQUIRE(glm::length(Vec2(boid.position.x, boid.position.z)) > 2);
        }
    }
}

}  // namespace limn::flock_test
