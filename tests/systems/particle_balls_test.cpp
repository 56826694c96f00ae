// Particles that bump into each other.

#include "ecs/base/rng.h"
#include "ecs/components/particle_balls.h"
#include "ecs/components/particle_collider.h"
#include "systems/particles/particle_balls_system.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::test::particle_balls_test {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Vec3 position(const ParticlePool& pool, std::size_t i) {
    return {pool.x[i], pool.y[i], pool.z[i]};
}
Vec3 velocity(const ParticlePool& pool, std::size_t i) {
    return {pool.vx[i], pool.vy[i], pool.vz[i]};
}

void add_ball(ParticlePool& pool, const Vec3& at, const Vec3& flies = Vec3(0)) {
    pool.x.push_back(at.x);
    pool.y.push_back(at.y);
    pool.z.push_back(at.z);
    pool.vx.push_back(flies.x);
    pool.vy.push_back(flies.y);
    pool.vz.push_back(flies.z);
    pool.age.push_back(1);
    pool.life.push_back(9);
    pool.look.push_back(static_cast<std::uint32_t>(pool.look.size()) * 77 + 5);
}

/// `count` in a box of this half extent about a point, at up to 5 m/s.
ParticlePool crowd(std::size_t count, float extent, const Vec3& about = Vec3(0)) {
    ParticlePool pool;
    Random random(1, 2, 3, 4);
    const auto anywhere = [&](float most) {
        const float x = random.uniform(-most, most);
        const float y = random.uniform(-most, most);
        return Vec3(x, y, random.uniform(-most, most));
    };
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 at = about + anywhere(extent);
        add_ball(pool, at, anywhere(5));
    }
    return pool;
}

Pairs found_pairs(const ParticlePool& pool, float radius) {
    std::vector<BallPair> pairs;
    find_ball_pairs(pool, radius, pairs);
    Pairs sorted;
    for (const BallPair& pair : pairs) {
        sorted.push_back(std::minmax(pair.a, pair.b));
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

Pairs all_pairs(const ParticlePool& pool, float radius) {
    Pairs pairs;
    for (std::uint32_t a = 0; a < pool.size(); ++a) {
        for (std::uint32_t b = a + 1; b < pool.size(); ++b) {
            const Vec3 offset = position(pool, b) - position(pool, a);
            if (glm::dot(offset, offset) < 4 * radius * radius) {
                pairs.emplace_back(a, b);
            }
        }
    }
    return pairs;
}

struct Motion {
    glm::dvec3 momentum = glm::dvec3(0);
    double energy = 0;
};

Motion motion_of(const ParticlePool& pool) {
    Motion sum;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const glm::dvec3 v(velocity(pool, i));
        sum.momentum += v;
        sum.energy += 0.5 * glm::dot(v, v);
    }
    return sum;
}

}  // namespace

TEST_CASE(
    "particle balls: the pairs are those of all against all"
    * technique("particle.interparticle")) {
    for (const float radius : {0.03f, 0.1f, 0.2f}) {
        for (const Vec3& about : {Vec3(0), Vec3(-300, 77, 1000)}) {
            CAPTURE(radius);
            const ParticlePool pool = crowd(2000, 2, about);
            const Pairs expected = all_pairs(pool, radius);
            CHECK(expected.size() > 10);
            CHECK(found_pairs(pool, radius) == expected);
        }
    }
    // In a plane, on a line, and one far away from the others.
    ParticlePool flat = crowd(500, 1);
    flat.y.assign(500, -3);
    CHECK(found_pairs(flat, 0.05f) == all_pairs(flat, 0.05f));
    flat.z.assign(500, 7);
    flat.x[100] = 1e7f;
    CHECK(found_pairs(flat, 0.01f) == all_pairs(flat, 0.01f));
}

TEST_CASE(
    "particle balls: two of them head-on exchange their velocities"
    * technique("particle.interparticle")) {
    ParticlePool pool;
    add_ball(pool, {-0.09f, 1, 0}, {3, 0, 0});
    add_ball(pool, {0.09f, 1, 0}, {-1, 0, 0});
    collide_balls({.radius = 0.1f, .bounce = 1}, {}, kStep, pool);
    CHECK(velocity(pool, 0).x == near(-1));
    CHECK(velocity(pool, 1).x == near(3));
    CHECK(velocity(pool, 0).y == 0.0f);
    CHECK(pool.x[0] == near(-0.1));  // half of the overlap each
    CHECK(pool.x[1] == near(0.1));
}

TEST_CASE(
    "particle balls: across the line between them velocities stay"
    * technique("particle.interparticle")) {
    ParticlePool pool;
    add_ball(pool, {0, 0, 0}, {2, 5, -3});
    add_ball(pool, {0.15f, 0, 0}, {-2, 1, 4});
    collide_balls({.radius = 0.1f, .bounce = 0.5f}, {}, kStep, pool);
    CHECK(velocity(pool, 0).y == 5.0f);
    CHECK(velocity(pool, 0).z == -3.0f);
    CHECK(velocity(pool, 1).y == 1.0f);
    CHECK(velocity(pool, 1).x - velocity(pool, 0).x == near(2));  // half of 4, apart
    // Those that fly apart already do not pull at each other.
    const ParticlePool before = pool;
    collide_balls({.radius = 0.1f, .bounce = 0.5f}, {}, kStep, pool);
    CHECK(same_bits(pool, before));
}

TEST_CASE(
    "particle balls: beyond the sum of the radii nothing happens"
    * technique("particle.interparticle")) {
    ParticlePool pool;
    add_ball(pool, {0, 0, 0}, {5, 0, 0});
    add_ball(pool, {0.2001f, 0, 0}, {-5, 0, 0});
    const ParticlePool before = pool;
    collide_balls({.radius = 0.1f}, {}, kStep, pool);
    CHECK(same_bits(pool, before));
}

TEST_CASE(
    "particle balls: momentum stays, and energy falls in a crowd, the more the less bounce"
    * technique("particle.interparticle")) {
    const ParticlePool begin = crowd(2000, 1);
    const Motion before = motion_of(begin);
    double last = before.energy;
    for (const float bounce : {0.7f, 0.3f, 0.0f}) {
        CAPTURE(bounce);
        ParticlePool pool = begin;
        collide_balls({.radius = 0.08f, .bounce = bounce}, {}, kStep, pool);
        CHECK(pool.vx != begin.vx);
        const Motion after = motion_of(pool);
        CHECK(glm::length(after.momentum - before.momentum) / 2000 < 1e-5);
        CHECK(after.energy < last);
        last = after.energy;
    }
}

TEST_CASE(
    "particle balls: of pairs that meet, each by itself, a bounce of 1 keeps the energy"
    * technique("particle.interparticle")) {
    ParticlePool pool;
    Random random(1, 2, 3, 4);
    for (int i = 0; i < 500; ++i) {
        const Vec3 at = {static_cast<float>(i), 0, 0};
        const Vec3 axis = random.direction();
        const Vec3 along = random.direction();
        const Vec3 other = random.direction();
        add_ball(pool, at - 0.09f * axis, 3.0f * along + 4.0f * axis);
        add_ball(pool, at + 0.09f * axis, 3.0f * other - 4.0f * axis);
    }
    const Motion before = motion_of(pool);
    ParticlePool half = pool;
    collide_balls({.radius = 0.1f, .bounce = 1}, {}, kStep, pool);
    CHECK(motion_of(pool).energy == near(before.energy));
    CHECK(glm::length(motion_of(pool).momentum - before.momentum) < 1e-3);
    collide_balls({.radius = 0.1f, .bounce = 0.5f}, {}, kStep, half);
    CHECK(motion_of(half).energy < 0.7 * before.energy);
}

TEST_CASE(
    "particle balls: two at one position part in a direction that is the same in each run"
    * technique("particle.interparticle")) {
    const auto run = [] {
        ParticlePool pool;
        add_ball(pool, {1, 2, 3});
        add_ball(pool, {1, 2, 3});
        collide_balls({.radius = 0.1f}, {}, kStep, pool);
        return pool;
    };
    const ParticlePool pool = run();
    CHECK(glm::distance(position(pool, 0), position(pool, 1)) == near(0.2));
    CHECK(same_bits(pool, run()));
}

TEST_CASE(
    "particle balls: one that sticks to a surface stays, and others bounce off it"
    * technique("particle.interparticle")) {
    ParticlePool pool;
    add_ball(pool, {0, 0, 0});
    add_ball(pool, {0.15f, 0, 0}, {-4, 0, 0});
    pool.stuck = {1, 0};
    collide_balls({.radius = 0.1f, .bounce = 1}, {}, kStep, pool);
    CHECK(position(pool, 0) == Vec3(0));
    CHECK(velocity(pool, 0) == Vec3(0));
    CHECK(pool.x[1] == near(0.2));
    CHECK(velocity(pool, 1).x == near(4));
}

TEST_CASE(
    "particle balls: a hundred thousand at one position terminate without NaN"
    * technique("particle.interparticle")) {
    ParticlePool pool;
    for (int i = 0; i < 100000; ++i) {
        add_ball(pool, {1, 1, 1});
    }
    std::vector<BallPair> pairs;
    find_ball_pairs(pool, 0.05f, pairs);
    CHECK(pairs.size() <= 64 * 100000u);
    collide_balls({.radius = 0.05f}, {}, kStep, pool);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        REQUIRE(is_finite(position(pool, i)));
    }
    ParticlePool none;
    collide_balls({}, {}, kStep, none);
    collide_balls({.radius = 0}, {}, kStep, pool);
    collide_balls({.radius = -1}, {}, kStep, pool);
    collide_balls({.radius = std::nanf("")}, {}, kStep, pool);
    CHECK(none.size() == 0);
}

TEST_CASE(
    "particle balls: poured into a bowl they come to rest in a heap, and hardly overlap"
    * technique("particle.interparticle")) {
    constexpr float kRadius = 0.05f;
    Emitters scene;
    ParticleEmitter emitter = steady(100);
    emitter.duration = 3;
    emitter.loop = false;
    emitter.shape = EmitterShape::Disc;
    emitter.size = {0.2f, 0, 0.2f};
    emitter.speed = -1;
    const Entity entity = scene.add(emitter);
    scene.world.add(entity, ParticleCollision{.bounce = 0.2f, .friction = 0.9f, .radius = kRadius});
    scene.world.add(entity, ParticleBalls{.radius = kRadius, .bounce = 0.3f});
    scene.world.create(
        ParticleCollider{.shape = ColliderShape::Sphere, .size = Vec3(0.8f), .hollow = true},
        WorldTransform{Affine{}});
    const auto run = [&](int steps) {
        for (int step = 0; step < steps; ++step) {
            scene.run();
            scene.world.run(update_particle_balls);
        }
    };
    run(900);
    const ParticlePool before = scene.pool();
    run(60);
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 300);
    float highest = -1;
    double overlap = 0;
    double speed = 0;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        CHECK(glm::length(position(pool, i)) < 0.8f - kRadius + 0.02f);
        highest = std::max(highest, pool.y[i]);
        speed += static_cast<double>(glm::distance(position(pool, i), position(before, i))) / 300;
        for (std::size_t j = 0; j < i; ++j) {
            const float apart = glm::distance(position(pool, i), position(pool, j));
            overlap = std::max(overlap, static_cast<double>(2 * kRadius - apart));
        }
    }
    MESSAGE("highest " << highest << " m, overlap " << overlap << " m, speed " << speed << " m/s");
    CHECK(highest > -0.55f);  // a layer of one would end at -0.6 m
    CHECK(overlap < 0.2 * kRadius);
    CHECK(speed < 0.05);
}

}  // namespace limn::test::particle_balls_test
