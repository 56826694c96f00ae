#include "ecs/components/camera.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "systems/particles/particle_kernels.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::particle_motion_test {

using namespace limn::test;

TEST_CASE(
    "particles: free fall is exact whatever the step, unlike Euler's"
    * technique("particle.integrator")) {
    for (const int steps : {10, 100}) {
        CAPTURE(steps);
        const float dt = 1.0f / static_cast<float>(steps);
        ParticlePool pool = random_pool(40);
        const ParticlePool start = pool;
        for (int i = 0; i < steps; ++i) {
            move_particles(
                particle_block(pool, 0, pool.size()), {.gravity = {0, -9.81f, 0}, .dt = dt});
        }
        for (std::size_t i = 0; i < pool.size(); ++i) {
            CHECK(pool.y[i] - start.y[i] - start.vy[i] == test::near(-4.905f).epsilon(2e-5));
            CHECK(pool.vy[i] - start.vy[i] == test::near(-9.81f).epsilon(1e-5));
            CHECK(pool.x[i] - start.x[i] == test::near(start.vx[i]).scale(20).epsilon(1e-5));
        }
    }
}

TEST_CASE(
    "particles: a jet has no clumps, births within a step are on its parabola"
    * technique("particle.stateless-script")) {
    // Forty births a step, thrown up and falling for 1.2 s.
    Emitters scene;
    ParticleEmitter emitter = steady(2400);
    emitter.speed = 3;
    scene.add(emitter, falling());
    scene.run(72);
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 2880);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const double age = static_cast<double>(pool.age[i]);
        CHECK(pool.vy[i] == test::near(3 - 9.81 * age).scale(9).epsilon(1e-5));
        CHECK(pool.y[i] == test::near(3 * age - 4.905 * age * age).scale(3).epsilon(1e-5));
    }
    // With drag, velocities are those of its decay, and younger ones are behind.
    ParticleMotion slowed;
    slowed.gravity = 0;
    slowed.drag = 12;
    Emitters smoke;
    smoke.add(emitter, slowed);
    smoke.run(10);
    const ParticlePool& puffs = smoke.pool();
    for (std::size_t i = 0; i < puffs.size(); ++i) {
        CHECK(puffs.vy[i] == test::near(3 * std::exp(-12 * puffs.age[i])).epsilon(1e-4));
        CHECK((i == 0 || puffs.y[i] < puffs.y[i - 1]));
    }
    // The rest of that is the integrator's.
    CHECK(puffs.y[0] == test::near(0.25).epsilon(0.15));
}

TEST_CASE("particles: with drag they fall as they should, whatever the step") {
    for (const float dt : {1.0f / 60, 1.0f / 20, 0.1f}) {
        CAPTURE(dt);
        Emitters scene(dt);
        ParticleEmitter emitter = burst(1);
        emitter.speed = 20;
        ParticleMotion motion = falling();
        motion.drag = 1.5f;
        motion.wind = {0, 2, 0};
        scene.add(emitter, motion);
        scene.run(static_cast<int>(std::round(3 / dt)));
        const double left = std::exp(-1.5 * 3);
        const double last = 2 - 9.81 / 1.5;
        CHECK(scene.pool().vy[0] == test::near(last + (20 - last) * left).epsilon(1e-5));
        // Places by means of velocities: off by (drag dt)^2 / 12 of what drag takes.
        const double position = last * 3 + (20 - last) * (1 - left) / 1.5;
        const double turned = (20 - last) / 1.5;
        const double bound = turned * std::pow(1.5 * static_cast<double>(dt), 2) / 12;
        CHECK(std::abs(static_cast<double>(scene.pool().y[0]) - position) < bound + 1e-4);
    }
}

TEST_CASE(
    "particles: Euler's integrators fall as far as their sums" * technique("particle.integrator")) {
    const auto fall = [](ParticleIntegrator integrator, float dt, int steps) {
        Emitters scene(dt);
        ParticleEmitter emitter = burst(1);
        emitter.speed = 0;
        ParticleMotion motion = falling();
        motion.integrator = integrator;
        scene.add(emitter, motion);
        scene.run(steps);
        return scene.pool().y[0];
    };
    using enum ParticleIntegrator;
    CHECK(fall(ExplicitEuler, 0.1f, 10) == test::near(-4.4145));
    CHECK(fall(ExplicitEuler, 0.01f, 100) == test::near(-4.85595));
    CHECK(fall(SemiImplicit, 0.1f, 10) == test::near(-5.3955));
    CHECK(fall(SemiImplicit, 0.01f, 100) == test::near(-4.95405));
    CHECK(fall(Average, 0.1f, 10) == test::near(-4.905));
    CHECK(
        (fall(ExplicitEuler, 0.1f, 10) + 4.905f) / (fall(ExplicitEuler, 0.01f, 100) + 4.905f)
        == test::near(10).epsilon(0.05));
}

namespace {

/// A particle 10 m from the axis, on x, after a step or more of 0.1 s; velocities in the plane.
struct Orbiting {
    Emitters scene = Emitters(0.1f);
    Orbiting(const Vec2& velocity, ParticleMotion motion, int steps = 1) {
        ParticleEmitter emitter = burst(1);
        emitter.speed = 0;
        emitter.life = 1e5f;
        motion.gravity = 0;
        const Entity entity = scene.add(emitter, motion);
        // Born, then moved to its start. The book's axis is z: its x, y are z, x here.
        scene.run();
        auto& pool = scene.world.get<ParticlePool>(entity);
        pool.z[0] = 10;
        pool.x[0] = pool.y[0] = pool.vy[0] = 0;
        pool.vz[0] = velocity.x;
        pool.vx[0] = velocity.y;
        scene.run(steps);
    }
    Vec2 position() { return {scene.pool().z[0], scene.pool().x[0]}; }
    Vec2 velocity() { return {scene.pool().vz[0], scene.pool().vx[0]}; }
};

}  // namespace

TEST_CASE(
    "particles: orbit and brake give the numbers of the book's update, by integrator"
    * technique("particle.gpu-update, particle.gpu-update-mrt")) {
    using enum ParticleIntegrator;
    const auto near = [](const Vec2& a, const Vec2& b) { return glm::distance(a, b) < 1e-5f; };
    Orbiting turned({3, 4}, {.orbit = 1, .integrator = SemiImplicit});
    CHECK(near(turned.velocity(), {0, 5}));
    CHECK(near(turned.position(), {10, 0.5f}));
    Orbiting one_pass({3, 4}, {.orbit = 1, .integrator = ExplicitEuler});
    CHECK(near(one_pass.velocity(), {0, 5}));
    CHECK(near(one_pass.position(), {10.3f, 0.4f}));
    Orbiting braked({3, 4}, {.brake = 2, .integrator = SemiImplicit});
    CHECK(near(braked.velocity(), {2.88f, 3.84f}));
    CHECK(near(braked.position(), {10.288f, 0.384f}));
    // A factor of the direction per 1/60 s: six of them in this step.
    const float half = 1 - std::pow(0.5f, 1 / 6.0f);
    Orbiting mixed({1, 0}, {.orbit = half, .integrator = SemiImplicit});
    CHECK(near(mixed.velocity(), {0.5f, 0.5f}));
    CHECK(near(Orbiting({3, 4}, {}).velocity(), {3, 4}));
    CHECK(near(Orbiting({3, 4}, {.integrator = ExplicitEuler}).position(), {10.3f, 0.4f}));
    // At rest after |v| / brake, and it stays.
    Orbiting stopped({3, 4}, {.brake = 2, .integrator = SemiImplicit}, 26);
    CHECK(stopped.velocity() == Vec2(0));
    // A polygon of tangents leaves the circle: r^2 grows by (v dt)^2 in each step.
    Orbiting around({0, 5}, {.orbit = 1, .integrator = SemiImplicit}, 100);
    CHECK(glm::length(around.position()) == test::near(11.180340));
    CHECK(glm::length(around.velocity()) == test::near(5));
    // On the axis and at rest nothing turns, and nothing is NaN.
    Orbiting still({0, 0}, {.orbit = 1, .brake = 1});
    CHECK(still.velocity() == Vec2(0));
    CHECK(still.position() == Vec2(10, 0));
}

TEST_CASE("particles: one thrown upward turns at v / g, v^2 / 2 g high") {
    Emitters scene(1.0f / 500);
    ParticleEmitter emitter = burst(1);
    emitter.speed = 7;
    scene.add(emitter, falling());
    float highest = 0;
    float when = 0;
    for (int i = 0; i < 500; ++i) {
        scene.run();
        if (scene.pool().y[0] > highest) {
            highest = scene.pool().y[0];
            when = scene.pool().age[0];
        }
    }
    CHECK(highest == test::near(49 / (2 * 9.81)).epsilon(1e-4));
    CHECK(when == test::near(7 / 9.81).epsilon(0.004));
}

TEST_CASE("particles: drag leads to the air's velocity and to the terminal speed") {
    Emitters scene;
    ParticleMotion motion = falling();
    motion.drag = 2;
    motion.wind = {3, 0, -1};
    scene.add(burst(20), motion);
    scene.run(600);
    for (std::size_t i = 0; i < scene.pool().size(); ++i) {
        CHECK(scene.pool().vx[i] == test::near(3).epsilon(1e-4));
        CHECK(scene.pool().vz[i] == test::near(-1).epsilon(1e-4));
        CHECK(scene.pool().vy[i] == test::near(-9.81 / 2).epsilon(0.02));  // of the step
    }
}

TEST_CASE("particles: opposite forces cancel") {
    Emitters scene;
    ParticleEmitter still = burst(1);
    still.speed = 0;
    ParticleMotion motion = falling(0);
    motion.turbulence = 0;
    scene.add(still, motion);
    scene.run(100);
    CHECK(scene.pool().y[0] == 0.0f);
    ParticlePool pool = random_pool(100);
    const ParticlePool before = pool;
    const ParticleBlock block = particle_block(pool, 0, pool.size());
    apply_vortex(block, {.around = 3, .toward = 2}, 0.1f);
    apply_vortex(block, {.around = -3, .toward = -2}, 0.1f);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        CHECK(pool.vx[i] == test::near(before.vx[i]).scale(1).epsilon(1e-5));
    }
}

TEST_CASE("particles: a vortex turns about its axis and pulls toward it, by unit vectors") {
    ParticlePool pool = random_pool(3);
    pool.x = {2, 0, 5};
    pool.y = {9, 1, 2};
    pool.z = {0, -3, 0};
    const ParticlePool before = pool;
    apply_vortex(
        particle_block(pool, 0, 3),
        {.origin = {5, 0, 0}, .axis = {0, 1, 0}, .around = 4, .toward = 6}, 0.5f);
    // The first is at -x of the axis: around it is +z, toward it +x.
    CHECK(pool.vx[0] - before.vx[0] == test::near(3));
    CHECK(pool.vz[0] - before.vz[0] == test::near(2));
    CHECK(pool.vy[0] == before.vy[0]);
    CHECK(pool.vx[2] == before.vx[2]);  // on the axis
    CHECK(pool.vz[2] == before.vz[2]);
}

TEST_CASE("particles: curl noise has no sources and the strength that it is asked for") {
    const Turbulence noise = {
        .strength = 2, .size = 1.5f, .drift_a = {5, 1, 2}, .drift_b = {-4, 2, 8}, .seed = 9};
    Random random(5, 6, 7, 8);
    double square = 0;
    constexpr int kCount = 4000;
    for (int i = 0; i < kCount; ++i) {
        const Vec3 at = {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)};
        square += static_cast<double>(glm::dot(curl_noise(at, noise), curl_noise(at, noise)));
        constexpr float h = 0.02f;
        double divergence = 0;
        double change = 0;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 step(0);
            step[axis] = h;
            const Vec3 slope =
                (curl_noise(at + step, noise) - curl_noise(at - step, noise)) / (2 * h);
            divergence += static_cast<double>(slope[axis]);
            change += static_cast<double>(glm::length(slope));
        }
        REQUIRE(std::abs(divergence) < 0.02 * change + 0.02);
    }
    CHECK(std::sqrt(square / kCount) == test::near(2).epsilon(0.03));
}

TEST_CASE("particles: gradients of the noise are those of differences, and continue across cells") {
    // An integral along a closed path is 0 for a gradient.
    Random random(5, 6, 7, 8);
    for (int i = 0; i < 50; ++i) {
        const Vec3 center = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
        double around = 0;
        double length = 0;
        constexpr int kSides = 400;
        for (int s = 0; s < kSides; ++s) {
            const auto at = [&](double t) {
                const double angle = 2 * 3.14159265358979 * t / kSides;
                return center + Vec3(std::cos(angle), 0.5 * std::sin(2 * angle), std::sin(angle));
            };
            const Vec3 path = at(s + 1) - at(s);
            const Vec3 slope = noise_gradient(at(s + 0.5), 77);
            around += static_cast<double>(glm::dot(slope, path));
            length += static_cast<double>(glm::length(slope) * glm::length(path));
        }
        CHECK(std::abs(around) < 1e-3 * length);
    }
}

TEST_CASE(
    "particles: a box about the camera keeps them, evenly, wherever it goes"
    * technique("engine.space-dust")) {
    Emitters scene;
    ParticleEmitter emitter = burst(4000);
    emitter.shape = EmitterShape::Box;
    emitter.size = {5, 5, 5};
    emitter.speed = 0;
    scene.add(emitter, falling(0));
    scene.world.add(scene.entities[0], ParticleWrap{.size = {10, 10, 0}});
    const Entity camera = scene.world.create(Camera{}, WorldTransform{});
    for (const Vec3& eye : {Vec3(0), Vec3(3, 1, 200), Vec3(-1234.5f, 77, 0)}) {
        scene.world.get<WorldTransform>(camera).world = affine_from(eye, Quat(1, 0, 0, 0), Vec3(1));
        scene.run();
        const ParticlePool& pool = scene.pool();
        REQUIRE(pool.size() == 4000);
        double octants[4] = {};
        for (std::size_t i = 0; i < pool.size(); ++i) {
            CHECK(std::abs(pool.x[i] - eye.x) <= 5.001f);
            CHECK(std::abs(pool.y[i] - eye.y) <= 5.001f);
            CHECK(std::abs(pool.z[i]) <= 5.001f);
            ++octants[(pool.x[i] > eye.x ? 1 : 0) + (pool.y[i] > eye.y ? 2 : 0)];
        }
        for (const double count : octants) {
            CHECK(count == test::near(1000).epsilon(0.1));
        }
    }
}

}  // namespace limn::particle_motion_test
