// Particles on the GPU collide with obstacles and with each other as on the CPU.

#include "ecs/components/particle_balls.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/shaders/particle_gpu.h"
#include "tests/near.h"
#include "tests/render/particle_executors.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn::test::gpu_particle_collision_test {

TEST_CASE("gpu particles: they bounce off planes, spheres and boxes where those of the CPU do") {
    for (const float radius : {0.0f, 0.03f}) {
        CAPTURE(radius);
        ParticleEmitter emitter = fountain();
        emitter.shape = EmitterShape::Box;
        emitter.size = {2, 0.5f, 2};
        Executors both(emitter, {});
        both.collide({.bounce = 0.4f, .friction = 0.7f, .radius = radius});
        both.add_obstacle({.shape = ColliderShape::Plane}, {0, 0, 0}, Quat(0.99f, 0.1f, 0, 0.05f));
        both.add_obstacle({.shape = ColliderShape::Sphere, .size = Vec3(0.8f)}, {1.5f, 1, 3});
        both.add_obstacle(
            {.shape = ColliderShape::Box, .size = {0.5f, 0.7f, 0.4f}}, {0, 1, 2.5f},
            Quat(0.9f, 0.2f, 0.3f, 0.1f));
        both.add_obstacle(
            {.shape = ColliderShape::Sphere, .size = Vec3(6), .hollow = true}, {1, 2, 3});
        both.step(90);
        const std::vector<GpuParticle> gpu = both.read();
        const ParticlePool& cpu = both.pool();
        REQUIRE(gpu.size() == cpu.size());
        REQUIRE(gpu.size() == 600);
        // Where a particle touches an edge, rounding decides which side it leaves by.
        std::size_t differ = 0;
        std::size_t bounced = 0;
        for (std::size_t i = 0; i < gpu.size(); ++i) {
            const Vec3 position = {cpu.x[i], cpu.y[i], cpu.z[i]};
            differ += glm::distance(Vec3(gpu[i].position_age), position) < 1e-3f ? 0 : 1;
            bounced += cpu.vy[i] > 0 || std::abs(cpu.vy[i]) < 0.1f ? 1 : 0;
        }
        CHECK(bounced > 100);
        CHECK(differ <= gpu.size() / 100);
    }
}

TEST_CASE("gpu particles: at 60 m/s none gets through a wall of a millimeter") {
    const ParticleEmitter emitter = outburst(60);
    ParticleMotion motion;
    motion.gravity = 0;
    Executors both(emitter, motion);
    both.collide({.bounce = 0.9f, .friction = 1});
    const Vec3 center = {1, 2, 3};  // of the emitter: a closed box of six walls
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-2.0f, 2.0f}) {
            Vec3 size(3);
            size[axis] = 0.0005f;
            Vec3 position = center;
            position[axis] += side;
            both.add_obstacle({.shape = ColliderShape::Box, .size = size}, position);
        }
    }
    both.step(120);
    const std::vector<GpuParticle> gpu = both.read();
    REQUIRE(gpu.size() == 800);
    for (const GpuParticle& one : gpu) {
        const Vec3 offset = glm::abs(Vec3(one.position_age) - center);
        CHECK(std::max({offset.x, offset.y, offset.z}) < 2.001f);
    }
}

TEST_CASE("gpu particles: they stick where they hit, or die there, as on the CPU") {
    for (const CollisionAction action : {CollisionAction::Stick, CollisionAction::Kill}) {
        CAPTURE(static_cast<int>(action));
        ParticleEmitter emitter = fountain();
        emitter.life = 3;
        Executors both(emitter, {});
        both.collide({.action = action});
        both.add_obstacle({.shape = ColliderShape::Plane}, {0, 0, 0});
        both.step(150);
        const std::vector<GpuParticle> gpu = both.read();
        const ParticlePool& cpu = both.pool();
        REQUIRE(gpu.size() == cpu.size());
        CHECK(largest_distance(gpu, cpu, 1) < 1e-3f);
        const auto resting = std::count_if(gpu.begin(), gpu.end(), [](const GpuParticle& one) {
            return Vec3(one.velocity_life) == Vec3(0);
        });
        CHECK((action == CollisionAction::Stick) == (resting > 200));
    }
}

/// Balls in a ball of 1 m that fly in all directions.
ParticleEmitter gas(int count, float speed) {
    ParticleEmitter emitter;
    emitter.rate = 0;
    emitter.bursts = {{.time = 0, .count = static_cast<float>(count)}};
    emitter.capacity = static_cast<std::uint32_t>(count);
    emitter.shape = EmitterShape::Ball;
    emitter.size = {1, 1, 1};
    emitter.cone = kPi;
    emitter.speed = speed;
    emitter.life = 100;
    return emitter;
}

Vec3 momentum_of(const std::vector<GpuParticle>& balls) {
    Vec3 sum(0);
    for (const GpuParticle& one : balls) {
        sum += Vec3(one.velocity_life);
    }
    return sum;
}

TEST_CASE(
    "gpu balls: where they meet in pairs they go where the CPU's go"
    * technique("particle.interparticle")) {
    for (const float bounce : {0.5f, 1.0f}) {
        CAPTURE(bounce);
        Executors both(gas(700, 1), {.gravity = 0});
        Executors free(gas(700, 1), {.gravity = 0});
        for (const Entity entity : {both.cpu, both.gpu}) {
            both.world.add(entity, ParticleBalls{.radius = 0.02f, .bounce = bounce});
        }
        both.step(20);
        free.step(20);
        const std::vector<GpuParticle> gpu = both.read();
        const std::vector<GpuParticle> alone = free.read();
        const ParticlePool& cpu = both.pool();
        REQUIRE(gpu.size() == 700);
        REQUIRE(cpu.size() == 700);
        std::size_t apart = 0;
        std::size_t bumped = 0;
        for (std::size_t i = 0; i < gpu.size(); ++i) {
            const Vec3 position = {cpu.x[i], cpu.y[i], cpu.z[i]};
            apart += glm::distance(Vec3(gpu[i].position_age), position) < 1e-4f ? 0 : 1;
            bumped += glm::distance(Vec3(alone[i].position_age), position) < 1e-3f ? 0 : 1;
        }
        CHECK(bumped > 60);
        CHECK(apart <= bumped / 10);  // three at once
    }
}

TEST_CASE(
    "gpu balls: momentum stays in a crowd, energy falls, and each run has the same bits"
    * technique("particle.interparticle")) {
    const auto crowd = [] {
        auto both = std::make_unique<Executors>(gas(1500, 0.4f), ParticleMotion{.gravity = 0});
        both->world.add(both->gpu, ParticleBalls{.radius = 0.05f, .bounce = 0.5f});
        both->step(1);
        return both;
    };
    const auto both = crowd();
    const auto energy_of = [](const std::vector<GpuParticle>& balls) {
        double sum = 0;
        for (const GpuParticle& one : balls) {
            const Vec3 v(one.velocity_life);
            sum += static_cast<double>(glm::dot(v, v));
        }
        return sum;
    };
    const std::vector<GpuParticle> first = both->read();
    both->step(30);
    const std::vector<GpuParticle> later = both->read();
    both->step(30);
    const std::vector<GpuParticle> last = both->read();
    CHECK(glm::length(momentum_of(last) - momentum_of(later)) < 1e-4f * 1500);
    CHECK(energy_of(last) < energy_of(later));
    CHECK(energy_of(last) < energy_of(first));
    const auto again = crowd();
    again->step(60);  // in one go
    const std::vector<GpuParticle> same = again->read();
    REQUIRE(same.size() == last.size());
    for (std::size_t i = 0; i < same.size(); ++i) {
        CHECK(same[i].position_age == last[i].position_age);
        CHECK(same[i].velocity_life == last[i].velocity_life);
    }
}

TEST_CASE(
    "gpu balls: in a window a pool that starts over takes few steps a frame, then has the same bits"
    * technique("particle.interparticle")) {
    ParticleEmitter emitter = gas(400, 0.4f);
    emitter.rate = 300;
    emitter.capacity = 900;
    Executors both(emitter, {.gravity = 0});
    both.world.add(both.gpu, ParticleBalls{.radius = 0.05f, .bounce = 0.5f});
    both.step(100);
    std::size_t frames = 0;
    std::size_t alive = 0;
    std::size_t largest = 0;  // steps of a frame
    std::uint64_t done = 0;
    for (; done < both.recorded().step && frames < 100; ++frames) {
        both.step(frames > 0 ? 1 : 0);  // time goes on
        const std::vector<GpuParticle> shown = both.read(true);
        CHECK(shown.size() >= alive);  // never one that is not born yet
        alive = shown.size();
        const GpuParticlePool& pool = *both.pools.pools().begin()->second;
        CHECK(pool.done > done);
        largest = std::max(largest, pool.balls.steps.size());
        CHECK(
            pool.count
            == both.recorded().kept()[pool.done - 1].first
                   + both.recorded().kept()[pool.done - 1].count);
        done = pool.done;
    }
    CHECK(frames > 4);
    CHECK(frames < 10);
    CHECK(largest < 20);
    const std::vector<GpuParticle> late = both.read(true);
    both.pools = *GpuParticlePools::create(both.device());
    const std::vector<GpuParticle> at_once = both.read();
    REQUIRE(late.size() == at_once.size());
    REQUIRE(late.size() > 400);
    for (std::size_t i = 0; i < late.size(); ++i) {
        CHECK(late[i].position_age == at_once[i].position_age);
        CHECK(late[i].velocity_life == at_once[i].velocity_life);
    }
}

TEST_CASE(
    "gpu balls: the neighbors of each are those of all against all"
    * technique("particle.interparticle")) {
    constexpr float kRadius = 0.03f;
    Executors both(gas(2000, 0), {.gravity = 0});
    both.world.add(both.gpu, ParticleBalls{.radius = kRadius});
    both.step(1);
    (void)both.read();
    Executors before(gas(2000, 0), {.gravity = 0});  // where they were before they bumped
    before.step(1);
    const std::vector<GpuParticle> balls = before.read();
    const GpuParticlePool& pool = *both.pools.pools().begin()->second;
    std::vector<std::uint32_t> near(std::size_t{2000} * layout::kBallNearWords);
    pool.balls.near.read(0, std::as_writable_bytes(std::span(near)));
    std::size_t pairs = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        std::vector<std::uint32_t> expected;
        for (std::uint32_t k = 0; k < 2000; ++k) {
            const float apart =
                glm::distance(Vec3(balls[i].position_age), Vec3(balls[k].position_age));
            if (i != k && apart < 2.2f * kRadius) {
                expected.push_back(k);
            }
        }
        const std::uint32_t* const own = &near[std::size_t{i} * layout::kBallNearWords];
        std::vector<std::uint32_t> found(own + 2, own + 2 + own[0]);
        std::sort(found.begin(), found.end());
        CHECK(found == expected);
        pairs += expected.size();
    }
    CHECK(pairs > 500);
}

TEST_CASE(
    "gpu balls: momentum stays where each overlaps more than its list holds"
    * technique("particle.interparticle")) {
    ParticleEmitter emitter = gas(400, 0);
    emitter.size = Vec3(0.12f);
    emitter.speed_spread = 0;
    Executors both(emitter, {.gravity = 0});
    both.world.add(both.gpu, ParticleBalls{.radius = 0.05f, .bounce = 0.5f});
    for (int i = 0; i < 5; ++i) {
        both.step(2);
        const std::vector<GpuParticle> balls = both.read();
        float sum = 0;
        for (const GpuParticle& one : balls) {
            sum += glm::length(Vec3(one.velocity_life));
        }
        CHECK(sum > 10);
        CHECK(glm::length(momentum_of(balls)) < 1e-4f * sum);
    }
}

TEST_CASE(
    "gpu balls: poured into a box they come to rest in a heap as high as the CPU's"
    * technique("particle.interparticle")) {
    ParticleEmitter emitter = fountain();
    emitter.rate = 150;
    emitter.capacity = 300;
    emitter.shape = EmitterShape::Disc;
    emitter.size = {0.2f, 0, 0.2f};
    emitter.speed = -0.5f;
    emitter.life = 100;
    Executors both(emitter, {});
    both.collide({.bounce = 0.2f, .friction = 0.8f, .radius = 0.05f});
    for (const Entity entity : {both.cpu, both.gpu}) {
        both.world.add(entity, ParticleBalls{.radius = 0.05f, .bounce = 0.3f});
    }
    both.add_obstacle({.shape = ColliderShape::Plane}, {1, 0, 3});
    for (int axis : {0, 2}) {
        for (const float side : {-1.0f, 1.0f}) {
            Vec3 size(1.5f);
            size[axis] = 0.5f;
            Vec3 position = {1, 1, 3};
            position[axis] += side * 0.9f;
            both.add_obstacle({.shape = ColliderShape::Box, .size = size}, position);
        }
    }
    both.step(420);
    const std::vector<GpuParticle> gpu = both.read();
    const ParticlePool& cpu = both.pool();
    REQUIRE(gpu.size() == 300);
    REQUIRE(cpu.size() == 300);
    double height[2] = {0, 0};
    double speed = 0;
    double deepest = 0;
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        const Vec3 at(gpu[i].position_age);
        CHECK(std::abs(at.x - 1) < 0.36f);  // within the walls
        CHECK(std::abs(at.z - 3) < 0.36f);
        CHECK(at.y > 0.049f);
        height[0] += static_cast<double>(cpu.y[i]) / 300;
        height[1] += static_cast<double>(at.y) / 300;
        speed += static_cast<double>(glm::length(Vec3(gpu[i].velocity_life))) / 300;
        for (std::size_t k = 0; k < i; ++k) {
            const float gap = glm::distance(at, Vec3(gpu[k].position_age));
            deepest = std::max(deepest, static_cast<double>(0.1f - gap));
        }
    }
    CHECK(height[1] == near(height[0]).epsilon(0.05));
    CHECK(speed < 0.1);
    CHECK(deepest < 0.02);
}

}  // namespace limn::test::gpu_particle_collision_test
