#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/camera.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_spray.h"
#include "ecs/components/weather.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "systems/particles/particle_births.h"
#include "systems/particles/particle_kernels.h"
#include "systems/particles/particle_system.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

/// A pool of particles anywhere, some of them dead.
ParticlePool random_pool(std::size_t count) {
    ParticlePool pool;
    Random random(3, 4, 5, 6);
    for (std::size_t i = 0; i < count; ++i) {
        for (auto* column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(random.uniform(-20.0f, 20.0f));
        }
        pool.age.push_back(random.uniform(0.0f, 2.0f));
        pool.life.push_back(random.uniform(1.0f, 3.0f));
        pool.look.push_back(random.word());
        pool.stuck.push_back(pool.look.back() & 1);
    }
    return pool;
}

bool same_bits(const ParticlePool& a, const ParticlePool& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.vx == b.vx && a.vy == b.vy && a.vz == b.vz
           && a.age == b.age && a.life == b.life && a.look == b.look && a.stuck == b.stuck
           && a.clock.born == b.clock.born;
}

}  // namespace

TEST_CASE(
    "particles: ten a step are ten, 2.5 a step are 250 in a hundred, none for a negative rate") {
    Emitters scene;
    scene.add(steady(10 / kStep));
    scene.add(steady(2.5f / kStep));
    scene.add(steady(-50));
    for (int i = 1; i <= 100; ++i) {
        scene.run();
        CHECK(scene.pool(0).size() == static_cast<std::size_t>(10 * i));
    }
    CHECK(scene.pool(1).size() == 250);
    CHECK(scene.pool(2).size() == 0);
}

TEST_CASE("particles: births that vary by half have the mean rate, whatever the step") {
    for (const float step : {1.0f / 200, 1.0f / 30}) {
        CAPTURE(step);
        Emitters scene(step);
        ParticleEmitter emitter = steady(300);
        emitter.rate_spread = 150;
        emitter.life = 0.01f;
        scene.add(emitter);
        const int steps = static_cast<int>(100 / step);
        scene.run(steps);
        CHECK(std::abs(static_cast<double>(scene.pool().clock.born) / 30000 - 1) < 0.01);
    }
}

TEST_CASE("particles: a rate along a curve gives its integral") {
    Emitters scene;
    ParticleEmitter emitter = steady(600);
    emitter.duration = 4;
    emitter.loop = false;
    emitter.rate_curve = {{0, 0}, {1, 1}};
    scene.add(emitter);
    scene.run(120);
    CHECK(std::abs(static_cast<double>(scene.pool().clock.born) - 300) <= 1);  // 600 t^2 / 8
    scene.run(300);
    CHECK(std::abs(static_cast<double>(scene.pool().clock.born) - 1200) <= 1);

    Emitters falling_rate;
    emitter.rate_curve = {{0, 1}, {1, 0}};
    emitter.life = 0.5f;
    falling_rate.add(emitter);
    std::size_t last = 0;
    for (int i = 0; i < 4; ++i) {
        falling_rate.run(55);
        CHECK((i == 0 || falling_rate.pool().size() < last));
        last = falling_rate.pool().size();
    }
}

TEST_CASE("particles: by screen area, half the area are half the births") {
    Emitters scene;
    const Entity eye =
        scene.world.create(Camera{.fov_y = 1}, WorldTransform{}, PreviousWorldTransform{Affine{}});
    const auto seen_from = [&](float distance) {
        scene.world.get<WorldTransform>(eye).world =
            affine_from({0, 0, distance}, Quat(1, 0, 0, 0), Vec3(1));
    };
    ParticleEmitter emitter = steady(1e5f);
    emitter.by_screen_area = true;
    emitter.size = {0.5f, 0.2f, 0.1f};
    seen_from(10);
    scene.add(emitter);
    scene.run(60);
    const auto near = static_cast<double>(scene.pool().clock.born);
    seen_from(10 * std::sqrt(2.0f));
    scene.run(60);
    const auto far = static_cast<double>(scene.pool().clock.born) - near;
    CHECK(far / near == test::near(0.5).epsilon(0.01));
    // A ball of 0.5 m at 10 m, in an image of 2 tan(0.5) by 16 / 9 of it.
    const double height = 2 * std::tan(0.5);
    const double share = 3.14159 * 0.25 / 99.75 / (height * height * 16 / 9);
    CHECK(near == test::near(1e5 * share).epsilon(0.01));
    seen_from(0.1f);
    scene.run(1);
    CHECK(
        static_cast<double>(scene.pool().clock.born) - near - far
        == test::near(1e5 / 60).epsilon(0.01));
}

TEST_CASE("particles: births are evenly spaced in time, across steps too") {
    Emitters scene;
    scene.add(steady(7 / kStep), falling(0));
    scene.run(5);
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 35);
    for (std::size_t i = 1; i < pool.size(); ++i) {
        CHECK(pool.age[i - 1] - pool.age[i] == test::near(kStep / 7).epsilon(1e-3));
        CHECK(pool.y[i - 1] - pool.y[i] == test::near(kStep / 7).epsilon(1e-3));  // 1 m/s
    }
    CHECK(pool.age.back() >= 0);
    CHECK(pool.age.front() <= 5 * kStep);
}

TEST_CASE("particles: as many are alive as are born in a lifetime, and go when it is over") {
    Emitters scene;
    ParticleEmitter emitter = steady(200);
    emitter.life = 1.5f;
    const Entity entity = scene.add(emitter);
    scene.run(300);
    for (int i = 0; i < 60; ++i) {
        scene.run();
        CHECK(std::abs(static_cast<int>(scene.pool().size()) - 300) <= 4);  // those of a step
        const ParticlePool& pool = scene.pool();
        CHECK(std::is_sorted(pool.age.rbegin(), pool.age.rend()));  // oldest first
        for (std::size_t p = 0; p < pool.size(); ++p) {
            REQUIRE(pool.age[p] < pool.life[p]);
        }
    }
    scene.world.get<ParticleEmitter>(entity).active = false;
    scene.run(91);
    CHECK(scene.pool().size() == 0);
}

TEST_CASE("particles: a full pool drops births and counts them") {
    Emitters scene;
    ParticleEmitter emitter = burst(90);
    emitter.rate = 60;
    emitter.capacity = 100;
    scene.add(emitter);
    scene.run(60);
    CHECK(scene.pool().size() == 100);
    CHECK(scene.pool().clock.born == 100);
    CHECK(scene.pool().clock.dropped == 50);  // 90 + 60 - 100
}

TEST_CASE("particles: bursts come at their time and again, and with the duration anew") {
    Emitters scene(0.1f);
    ParticleEmitter emitter = steady(0);
    emitter.bursts = {{.time = 0.25f, .count = 5, .spread = 0, .interval = 0.5f, .repeats = 2}};
    scene.add(emitter);
    emitter.duration = 0.65f;
    scene.add(emitter);
    emitter.loop = false;
    scene.add(emitter);
    std::vector<int> once;
    std::vector<int> looped;
    std::vector<int> ended;
    for (int i = 0; i < 20; ++i) {
        scene.run();
        once.push_back(static_cast<int>(scene.pool(0).clock.born));
        looped.push_back(static_cast<int>(scene.pool(1).clock.born));
        ended.push_back(static_cast<int>(scene.pool(2).clock.born));
    }
    // At 0.25, 0.75 and 1.25 s.
    CHECK(once[1] == 0);
    CHECK(once[2] == 5);
    CHECK(once[7] == 10);
    CHECK(once[12] == 15);
    CHECK(once.back() == 15);
    // Only the first is within 0.65 s: at 0.25, 0.9 and 1.55 s.
    CHECK(looped[2] == 5);
    CHECK(looped[7] == 5);
    CHECK(looped[9] == 10);
    CHECK(looped[15] == 15);
    CHECK(looped.back() == 15);
    CHECK(ended.back() == 5);
}

TEST_CASE("particles: attributes are within their spread, and reach its ends") {
    Emitters scene;
    ParticleEmitter emitter = burst(5000);
    emitter.speed = 3;
    emitter.speed_spread = 1;
    emitter.life = 2;
    emitter.life_spread = 0.5f;
    scene.add(emitter, falling(0));
    scene.run();
    const ParticlePool& pool = scene.pool();
    const auto [slow, fast] = std::minmax_element(pool.vy.begin(), pool.vy.end());
    CHECK(*slow >= 2.0f);
    CHECK(*slow < 2.01f);
    CHECK(*fast <= 4.0f);
    CHECK(*fast > 3.99f);
    const auto [early, late] = std::minmax_element(pool.life.begin(), pool.life.end());
    CHECK(*early >= 1.5f);
    CHECK(*late <= 2.5f);
    CHECK(*late - *early > 0.99f);
}

TEST_CASE("particles: shapes are filled evenly") {
    Random random(1, 2, 3, 4);
    constexpr int kCount = 100000;
    struct Case {
        EmitterShape shape;
        double half_share;  // of the points, within half the radius
        int axes;           // that have an extent
    };
    for (const Case& one :
         {Case{EmitterShape::Ball, 0.125, 3}, Case{EmitterShape::Disc, 0.25, 2},
          Case{EmitterShape::Sphere, 0, 3}, Case{EmitterShape::Circle, 0, 2}}) {
        CAPTURE(static_cast<int>(one.shape));
        const Vec3 size = {2, 3, 4};
        int near = 0;
        glm::dvec3 sum(0);
        for (int i = 0; i < kCount; ++i) {
            const Vec3 p = sample_shape(one.shape, size, random) / size;
            const float radius = glm::length(p);
            REQUIRE(radius <= 1.00001f);
            REQUIRE((one.half_share > 0 || radius >= 0.99999f));
            REQUIRE((one.axes == 3 || p.y == 0.0f));
            near += radius < 0.5f ? 1 : 0;
            sum += glm::dvec3(p);
        }
        CHECK(near / double{kCount} == test::near(one.half_share).scale(1).epsilon(0.005));
        CHECK(glm::length(sum) / kCount < 0.01);
    }
    Vec3 high(0);
    for (int i = 0; i < kCount; ++i) {
        const Vec3 p = sample_shape(EmitterShape::Box, {1, 2, 3}, random);
        high = glm::max(high, glm::abs(p));
        REQUIRE(glm::all(glm::lessThanEqual(glm::abs(p), Vec3(1, 2, 3))));
    }
    CHECK(glm::length(high - Vec3(1, 2, 3)) < 0.01f);
    CHECK(sample_shape(EmitterShape::Point, {1, 2, 3}, random) == Vec3(0));
}

TEST_CASE("particles: the torus of the book is a ring without a hole in its tube") {
    Random random(1, 2, 3, 4);
    Vec3 sum(0);
    int inner = 0;
    constexpr int kCount = 50000;
    for (int i = 0; i < kCount; ++i) {
        const Vec3 p = sample_shape(EmitterShape::Torus, {10, 1, 10}, random);
        const float across = std::sqrt(p.x * p.x + p.z * p.z) - 10;
        REQUIRE(across * across + p.y * p.y <= 1.00001f);
        inner += across * across + p.y * p.y < 0.5f ? 1 : 0;
        sum += p;
    }
    CHECK(inner / double{kCount} == test::near(0.5).epsilon(0.02));
    CHECK(glm::length(sum) / kCount < 0.1f);
}

TEST_CASE("particles: a shell's radii vary by axis, and an axis of 0 leaves a ring") {
    Emitters scene;
    ParticleEmitter emitter = burst(20000);
    emitter.shape = EmitterShape::Sphere;
    emitter.size = {10, 10, 0};
    emitter.size_spread = {1, 1, 1};
    emitter.speed = 0;
    scene.add(emitter, falling(0));
    scene.run();
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 20000);
    const float reach = std::sqrt(2.0f);
    float thick = 0;
    float nearest = 20;
    float farthest = 0;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const float radius = std::sqrt(pool.x[i] * pool.x[i] + pool.y[i] * pool.y[i]);
        nearest = std::min(nearest, radius);
        farthest = std::max(farthest, radius);
        thick = std::max(thick, std::abs(pool.z[i]));
    }
    CHECK(nearest >= 10 - reach);
    CHECK(nearest < 10 - 0.9f * reach);
    CHECK(farthest <= 10 + reach);
    CHECK(farthest > 10 + 0.9f * reach);
    CHECK(thick <= 1);
    CHECK(thick > 0.99f);
}

TEST_CASE("particles: velocities vary by axis, each by itself, and a small shell is a point") {
    Emitters scene;
    ParticleEmitter emitter = burst(20000);
    emitter.shape = EmitterShape::Sphere;
    emitter.size = Vec3(0.001f);
    emitter.speed = 5;
    emitter.velocity_spread = {2, 1, 0.5f};
    scene.add(emitter, falling(0));
    scene.run();
    const ParticlePool& pool = scene.pool();
    const auto reach = [](const std::vector<float>& v, float mean) {
        float most = 0;
        double sum = 0;
        for (const float x : v) {
            most = std::max(most, std::abs(x - mean));
            sum += x;
        }
        CHECK(sum / static_cast<double>(v.size()) == near(mean).scale(1).epsilon(0.03));
        return most;
    };
    CHECK(reach(pool.vx, 0) == near(2).epsilon(0.001));
    CHECK(reach(pool.vy, 5) == near(1).epsilon(0.001));
    CHECK(reach(pool.vz, 0) == near(0.5).epsilon(0.001));
    double product = 0;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        product += pool.vx[i] * (pool.vy[i] - 5);
    }
    CHECK(std::abs(product / 20000) < 0.02);
}

TEST_CASE("particles: a linear population is born once, as many as the capacity") {
    Emitters scene;
    ParticleEmitter emitter = steady(600);
    emitter.population = ParticlePopulation::Linear;
    emitter.capacity = 50;
    emitter.life = 0.05f;
    scene.add(emitter);
    std::uint64_t last = 0;
    for (int i = 0; i < 60; ++i) {
        scene.run();
        const ParticlePool& pool = scene.pool();
        CHECK(pool.clock.born >= last);
        CHECK(pool.clock.born <= 50);
        CHECK(pool.size() <= pool.clock.born);
        // First in, first out: those alive are the youngest, in the order of their births.
        CHECK(std::is_sorted(pool.age.rbegin(), pool.age.rend()));
        last = pool.clock.born;
    }
    CHECK(last == 50);
    CHECK(scene.pool().size() == 0);
    CHECK(scene.pool().clock.dropped == 550);
}

TEST_CASE("particles: a rate of capacity / life holds the population at the capacity") {
    // The source's example: fifty in all, a life of a second.
    Emitters scene;
    ParticleEmitter emitter = steady(50);
    emitter.capacity = 50;
    emitter.life = 1;
    scene.add(emitter);
    std::uint64_t begun = 0;
    for (int i = 0; i < 600; ++i) {
        scene.run();
        CHECK(scene.pool().size() <= 50);
        if (i == 119) {
            begun = scene.pool().clock.born;
        }
        if (i > 60) {
            CHECK(scene.pool().size() >= 49);
        }
    }
    CHECK(std::abs(static_cast<double>(scene.pool().clock.born - begun) - 8 * 50) <= 8);
}

TEST_CASE("particles: directions are unit, within the cone, even over its cap") {
    Random random(1, 2, 3, 4);
    constexpr int kCount = 50000;
    const float cone = 0.7f;
    const float middle = 0.5f * (1 + std::cos(cone));  // halves the cap's area
    int inner = 0;
    for (int i = 0; i < kCount; ++i) {
        const Vec3 v = sample_cone(cone, random);
        REQUIRE(std::abs(glm::length(v) - 1) < 1e-5f);
        REQUIRE(v.y >= std::cos(cone) - 1e-6f);
        inner += v.y > middle ? 1 : 0;
    }
    CHECK(inner / double{kCount} == test::near(0.5).epsilon(0.02));
}

TEST_CASE("particles: free fall is exact whatever the step, unlike Euler's") {
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

TEST_CASE("particles: a jet has no clumps, births within a step are on its parabola") {
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
    // With drag, velocities are those of its decay, and whoever is younger is behind.
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
        const double place = last * 3 + (20 - last) * (1 - left) / 1.5;
        const double turned = (20 - last) / 1.5;
        const double bound = turned * std::pow(1.5 * static_cast<double>(dt), 2) / 12;
        CHECK(std::abs(static_cast<double>(scene.pool().y[0]) - place) < bound + 1e-4);
    }
}

TEST_CASE("particles: Euler's integrators fall as far as their sums") {
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
        // Born, then put in its place. The book's axis is z: its x, y are z, x here.
        scene.run();
        auto& pool = scene.world.get<ParticlePool>(entity);
        pool.z[0] = 10;
        pool.x[0] = pool.y[0] = pool.vy[0] = 0;
        pool.vz[0] = velocity.x;
        pool.vx[0] = velocity.y;
        scene.run(steps);
    }
    Vec2 place() { return {scene.pool().z[0], scene.pool().x[0]}; }
    Vec2 velocity() { return {scene.pool().vz[0], scene.pool().vx[0]}; }
};

}  // namespace

TEST_CASE("particles: orbit and brake give the numbers of the book's update, by integrator") {
    using enum ParticleIntegrator;
    const auto near = [](const Vec2& a, const Vec2& b) { return glm::distance(a, b) < 1e-5f; };
    Orbiting turned({3, 4}, {.orbit = 1, .integrator = SemiImplicit});
    CHECK(near(turned.velocity(), {0, 5}));
    CHECK(near(turned.place(), {10, 0.5f}));
    Orbiting one_pass({3, 4}, {.orbit = 1, .integrator = ExplicitEuler});
    CHECK(near(one_pass.velocity(), {0, 5}));
    CHECK(near(one_pass.place(), {10.3f, 0.4f}));
    Orbiting braked({3, 4}, {.brake = 2, .integrator = SemiImplicit});
    CHECK(near(braked.velocity(), {2.88f, 3.84f}));
    CHECK(near(braked.place(), {10.288f, 0.384f}));
    // A factor of the direction per 1/60 s: six of them in this step.
    const float half = 1 - std::pow(0.5f, 1 / 6.0f);
    Orbiting mixed({1, 0}, {.orbit = half, .integrator = SemiImplicit});
    CHECK(near(mixed.velocity(), {0.5f, 0.5f}));
    CHECK(near(Orbiting({3, 4}, {}).velocity(), {3, 4}));
    CHECK(near(Orbiting({3, 4}, {.integrator = ExplicitEuler}).place(), {10.3f, 0.4f}));
    // At rest after |v| / brake, and it stays.
    Orbiting stopped({3, 4}, {.brake = 2, .integrator = SemiImplicit}, 26);
    CHECK(stopped.velocity() == Vec2(0));
    // A polygon of tangents leaves the circle: r^2 grows by (v dt)^2 in each step.
    Orbiting around({0, 5}, {.orbit = 1, .integrator = SemiImplicit}, 100);
    CHECK(glm::length(around.place()) == test::near(11.180340));
    CHECK(glm::length(around.velocity()) == test::near(5));
    // On the axis and at rest nothing turns, and nothing is NaN.
    Orbiting still({0, 0}, {.orbit = 1, .brake = 1});
    CHECK(still.velocity() == Vec2(0));
    CHECK(still.place() == Vec2(10, 0));
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
    whirl_particles(block, {.around = 3, .toward = 2}, 0.1f);
    whirl_particles(block, {.around = -3, .toward = -2}, 0.1f);
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
    whirl_particles(
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
    // An integral over a closed way is 0 for a gradient.
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
            const Vec3 way = at(s + 1) - at(s);
            const Vec3 slope = noise_gradient(at(s + 0.5), 77);
            around += static_cast<double>(glm::dot(slope, way));
            length += static_cast<double>(glm::length(slope) * glm::length(way));
        }
        CHECK(std::abs(around) < 1e-3 * length);
    }
}

/// Emitter 0 and one that is born of its particles.
struct Family : Emitters {
    Family(const ParticleEmitter& parent, const ParticleEmitter& child, ParticleSource source) {
        const Entity first = add(parent, falling(0));
        source.emitter = first;
        world.add(add(child, falling(0)), source);
    }
};

TEST_CASE("particle source: a death gives birth where and when it happens, count times") {
    ParticleEmitter parent = burst(10);
    parent.life = 0.505f;
    parent.speed = 20;
    ParticleEmitter child = steady(50);
    child.speed = 0;
    child.life = 0.4f;
    Family scene(parent, child, {.at = ParticleMoment::Death, .count = 7, .inherit = 0.5f});
    scene.run(30);
    CHECK(scene.pool(0).size() == 10);
    CHECK(scene.pool(1).size() == 0);  // not by its own rate
    scene.run(1);
    CHECK(scene.pool(0).size() == 0);
    const ParticlePool& pool = scene.pool(1);
    REQUIRE(pool.size() == 70);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const double age = 31 * static_cast<double>(kStep) - 0.505;
        CHECK(pool.age[i] == test::near(age).epsilon(1e-3));
        CHECK(pool.y[i] == test::near(20 * 0.505 + 10 * age).epsilon(1e-4));
        CHECK(pool.vy[i] == test::near(10));
    }
    CHECK(pool.clock.born == 70);
    scene.run(25);
    CHECK(scene.pool(1).size() == 0);
}

TEST_CASE("particle source: births are followed in the same step, those of children in the next") {
    Family scene(steady(2 / kStep), steady(0), {.at = ParticleMoment::Birth, .count = 3});
    const Entity grandchild = scene.add(steady(0));
    scene.world.add(
        grandchild,
        ParticleSource{.emitter = scene.entities[1], .at = ParticleMoment::Birth, .count = 2});
    for (std::size_t step = 1; step < 20; ++step) {
        scene.run();
        CHECK(scene.pool(0).size() == 2 * step);
        CHECK(scene.pool(1).size() == 6 * step);
        CHECK(scene.pool(2).size() == 12 * (step - 1));
    }
}

TEST_CASE("particle source: a trail is even in time, whatever the frame rate") {
    ParticleEmitter parent = burst(1);
    parent.speed = 6;
    parent.life = 1;
    ParticleEmitter child = steady(100);
    child.speed = 0;
    for (const float step : {1.0f / 60, 1.0f / 24, 1.0f / 11}) {
        Emitters scene(step);
        scene.add(parent, falling(0));
        scene.add(child, falling(0));
        scene.world.add(
            scene.entities[1],
            ParticleSource{
                .emitter = scene.entities[0], .at = ParticleMoment::Flight, .inherit = 0});
        scene.run(static_cast<int>(1.5f / step));
        const ParticlePool& pool = scene.pool(1);
        CHECK(std::abs(static_cast<int>(pool.size()) - 100) <= 1);
        for (std::size_t i = 1; i < pool.size(); ++i) {
            CHECK(pool.y[i] - pool.y[i - 1] == test::near(0.06).epsilon(2e-3));
        }
    }
}

TEST_CASE("particle source: no births of itself, of nothing, or over capacity, which are counted") {
    Emitters scene;
    ParticleEmitter parent = burst(100);
    parent.life = 0.1f;
    scene.add(parent);
    ParticleEmitter child = steady(0);
    child.capacity = 150;
    scene.add(child);
    scene.world.add(
        scene.entities[1],
        ParticleSource{.emitter = scene.entities[0], .at = ParticleMoment::Death, .count = 2});
    scene.add(burst(5));
    scene.world.add(
        scene.entities[2],
        ParticleSource{.emitter = scene.entities[2], .at = ParticleMoment::Birth});
    scene.add(burst(5));
    scene.world.add(scene.entities[3], ParticleSource{});
    scene.run(10);
    CHECK(scene.pool(1).size() == 150);
    CHECK(scene.pool(1).clock.dropped == 50);
    CHECK(scene.pool(2).size() == 0);
    CHECK(scene.pool(3).size() == 0);
    scene.world.destroy(scene.entities[0]);
    scene.run(10);
    CHECK(scene.pool(1).size() == 150);
}

TEST_CASE("particles: a box about the camera keeps them, evenly, wherever it goes") {
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

TEST_CASE("particles: a prewarmed emitter starts as another is after that time") {
    Emitters scene;
    ParticleEmitter emitter = steady(60);
    emitter.life = 1;
    scene.add(emitter, falling());
    emitter.prewarm = 3;
    scene.add(emitter, falling());
    scene.run();
    CHECK(scene.pool(0).size() == 1);
    CHECK(scene.pool(1).size() == test::near(60).epsilon(0.04));
    CHECK(scene.pool(1).clock.time == test::near(3 + 1.0 / 60).epsilon(1e-3));
    scene.run(240);
    CHECK(
        scene.pool(0).size()
        == test::near(static_cast<double>(scene.pool(1).size())).epsilon(0.04));
    CHECK(scene.pool(1).clock.born == test::near(60 * 7).epsilon(0.02));
}

TEST_CASE("particles: vectors give the bits of the plain loops, for any number") {
    for (const std::size_t count : {1u, 7u, 16u, 33u, 1000u, 40001u}) {
        CAPTURE(count);
        ParticlePool a = random_pool(count);
        ParticlePool b = a;
        const Turbulence noise = {
            .strength = 3, .size = 0.7f, .drift_a = {1, 2, 3}, .drift_b = {4, 5, 6}, .seed = 8};
        const ParticleStep step = {
            .gravity = {0.1f, -9.8f, 0.3f},
            .air = {2, 1, -1},
            .keep = 0.93f,
            .dt = 0.017f,
            .old_share = 0.3f};
        stir_particles(particle_block(a, 0, count), noise, 0.02f);
        stir_particles_scalar(particle_block(b, 0, count), noise, 0.02f);
        CHECK(same_bits(a, b));
        const std::size_t dead = move_particles(particle_block(a, 0, count), step);
        CHECK(dead == move_particles_scalar(particle_block(b, 0, count), step));
        CHECK(same_bits(a, b));
        CHECK(remove_dead(a, 0) == count - dead);
        CHECK(remove_dead_scalar(b, 0) == count - dead);
        CHECK(same_bits(a, b));
        CHECK(a.size() == count - dead);
    }
}

TEST_CASE("particles: moving a part of a pool leaves its neighbors as they are") {
    const ParticleStep step = {.gravity = {0, -9.8f, 0}, .dt = 0.017f};
    for (std::size_t count = 0; count <= 40; ++count) {
        CAPTURE(count);
        ParticlePool a = random_pool(60);
        ParticlePool b = a;
        const std::size_t dead = move_particles(particle_block(a, 9, count), step);
        CHECK(dead == move_particles_scalar(particle_block(b, 9, count), step));
        CHECK(same_bits(a, b));
    }
}

TEST_CASE("particles: the dead leave in place, the others keep their order") {
    ParticlePool pool = random_pool(500);
    std::vector<std::uint32_t> expected(pool.look.begin(), pool.look.begin() + 100);
    for (std::size_t i = 100; i < 500; ++i) {
        if (pool.age[i] < pool.life[i]) {
            expected.push_back(pool.look[i]);
        }
    }
    REQUIRE(expected.size() < 450);
    remove_dead(pool, 100);
    CHECK(pool.look == expected);
    CHECK(pool.x.size() == expected.size());
    REQUIRE(pool.stuck.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(pool.stuck[i] == (pool.look[i] & 1));
    }
}

TEST_CASE("particles: drops that waves throw up fly on from where they are, up to the capacity") {
    Emitters scene;
    ParticleEmitter emitter = steady(0);
    emitter.capacity = 30;
    const Entity entity = scene.add(emitter, falling(0));
    scene.world.add(
        entity, SprayDrops{.drops = std::vector<SprayDrop>(20, {{1, 2, 3}, {6, 0, 0}})});
    scene.run();
    REQUIRE(scene.pool().size() == 20);
    for (std::size_t i = 0; i < 20; ++i) {
        CHECK(scene.pool().x[i] >= 1.0f);
        CHECK(scene.pool().x[i] <= 1 + 6 * kStep + 1e-5f);
        CHECK(scene.pool().x[i] - 1 == test::near(6 * scene.pool().age[i]).scale(1).epsilon(1e-5));
        CHECK(scene.pool().y[i] == 2.0f);
    }
    CHECK(scene.pool().x[0] != scene.pool().x[1]);
    scene.world.get<ParticleEmitter>(entity).drop_speed = 2;
    scene.run();
    CHECK(scene.pool().size() == 30);
    CHECK(scene.pool().clock.dropped == 10);
    CHECK(scene.pool().vx[0] == 6.0f);
    CHECK(scene.pool().vx.back() == 12.0f);
}

TEST_CASE("particles: a moving emitter leaves no gaps, and gives on its velocity") {
    Emitters scene;
    ParticleEmitter emitter = steady(10 / kStep);
    emitter.speed = 0;
    emitter.inherit = 0;
    const Entity entity = scene.add(emitter, falling(0));
    const auto place = [](float x) { return affine_from({x, 0, 0}, Quat(1, 0, 0, 0), Vec3(1)); };
    scene.world.get<WorldTransform>(entity).world = place(6);
    scene.world.get<PreviousWorldTransform>(entity).world = place(5);
    scene.run();
    REQUIRE(scene.pool().size() == 10);
    for (std::size_t i = 0; i < 10; ++i) {
        CHECK(scene.pool().x[i] == test::near(5.1 + 0.1 * static_cast<double>(i)));
    }
    scene.world.get<ParticleEmitter>(entity).inherit = 0.5f;
    scene.run();
    CHECK(scene.pool().vx.back() == test::near(30));  // of 60 m/s
}

TEST_CASE("particles: two emitters alike differ, unless they have the same seed") {
    Emitters scene;
    ParticleEmitter emitter = burst(50);
    emitter.shape = EmitterShape::Ball;
    scene.add(emitter);
    scene.add(emitter);
    emitter.seed = 5;
    scene.add(emitter);
    scene.add(emitter);
    scene.run(3);
    CHECK(scene.pool(0).x != scene.pool(1).x);
    CHECK(scene.pool(2).x == scene.pool(3).x);
    CHECK(scene.pool(2).look == scene.pool(3).look);
}

TEST_CASE("particles: threads do not change the bits, nor does a snapshot in between") {
    const auto build = [](Emitters& scene) {
        ParticleEmitter emitter = steady(20000);
        emitter.shape = EmitterShape::Ball;
        emitter.life = 0.3f;
        emitter.life_spread = 0.2f;
        emitter.cone = 1;
        ParticleMotion motion;
        motion.drag = 1;
        motion.turbulence = 5;
        motion.vortex = 2;
        for (int i = 0; i < 3; ++i) {
            scene.add(emitter, motion);
        }
    };
    const int threads = thread_count();
    std::vector<ParticlePool> expected;
    for (const int count : {1, 2, 7}) {
        CAPTURE(count);
        set_thread_count(count);
        Emitters scene;
        build(scene);
        scene.run(20);
        const Result<std::vector<std::byte>> saved = save_snapshot(scene.world);
        REQUIRE(saved.ok());
        scene.run(20);
        if (expected.empty()) {
            for (std::size_t i = 0; i < 3; ++i) {
                expected.push_back(scene.pool(i));
            }
        }
        for (std::size_t i = 0; i < 3; ++i) {
            REQUIRE(scene.pool(i).size() > 3000);
            CHECK(same_bits(scene.pool(i), expected[i]));
        }
        REQUIRE(restore_snapshot(scene.world, *saved).ok());
        scene.run(20);
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(same_bits(scene.pool(i), expected[i]));
        }
    }
    set_thread_count(threads);
}

TEST_CASE("particles: an emitter moves the same whether or not others are born by it") {
    // Whoever gives birth to nobody is stepped at once, together with others alike.
    ParticleEmitter emitter = steady(90);
    emitter.shape = EmitterShape::Ball;
    emitter.bursts = {{.time = 0.2f, .count = 30, .spread = 9, .interval = 0.3f, .repeats = 2}};
    emitter.life = 0.5f;
    emitter.life_spread = 0.2f;
    emitter.speed_spread = 1;
    ParticleMotion swirling = falling();
    swirling.vortex = 3;
    swirling.orbit = 0.1f;
    swirling.drag = 0.5f;
    Emitters alone;
    Emitters parents;
    constexpr std::size_t kCount = 5;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        emitter.seed = i + 1;
        emitter.rate = i == 3 ? 0.0f : 90.0f;
        emitter.active = i != 4;
        const ParticleMotion motion = i == 1 ? falling() : swirling;
        for (Emitters* const scene : {&alone, &parents}) {
            const Entity added = scene->add(emitter, motion);
            scene->world.get<WorldTransform>(added).world =
                affine_from(Vec3(static_cast<float>(i), 0, 0), Quat(1, 0, 0, 0), Vec3(1));
            scene->world.get<PreviousWorldTransform>(added).world =
                scene->world.get<const WorldTransform>(added).world;
        }
    }
    for (std::size_t i = 0; i < kCount; ++i) {
        parents.world.create(
            steady(0), ParticleSource{.emitter = parents.entities[i], .count = 0}, WorldTransform{},
            PreviousWorldTransform{Affine{}});
    }
    parents.world.run(add_particle_pools);
    for (int step = 0; step < 90; ++step) {
        alone.run();
        parents.run();
        for (std::size_t i = 0; i < kCount; ++i) {
            CAPTURE(i);
            CHECK(same_bits(alone.pool(i), parents.pool(i)));
            CHECK(alone.pool(i).clock.time == parents.pool(i).clock.time);
            CHECK(alone.pool(i).clock.carry == parents.pool(i).clock.carry);
            CHECK(alone.pool(i).fresh == parents.pool(i).fresh);
        }
    }
    CHECK(alone.pool(0).size() > 30);
    CHECK(alone.pool(3).clock.born > 60);
    CHECK(alone.pool(4).clock.born == 0);
}

TEST_CASE("particles: wrapping by vectors gives the bits of the plain loop") {
    for (const std::size_t count : {0u, 1u, 7u, 16u, 33u, 100u}) {
        ParticlePool plain = random_pool(count);
        ParticlePool pool = plain;
        wrap_particles_scalar(particle_block(plain, 0, count), {3, 4, 5}, {7, 0, 2.5f});
        wrap_particles(particle_block(pool, 0, count), {3, 4, 5}, {7, 0, 2.5f});
        CHECK(same_bits(plain, pool));
        const ParticlePool before = random_pool(count);
        CHECK(pool.y == before.y);
        for (std::size_t i = 0; i < count; ++i) {
            CHECK(std::abs(pool.x[i] - 3) <= 3.5001f);
            const float turns = (pool.x[i] - before.x[i]) / 7;
            CHECK(turns == test::near(std::round(turns)));
        }
    }
}

TEST_CASE("particles: no number makes a NaN, a hang or more than fits") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    for (const float bad : {kNan, kInf, -kInf, 1e9f, -1e9f, 0.0f}) {
        CAPTURE(bad);
        for (int field = 0; field < 10; ++field) {
            CAPTURE(field);
            Emitters scene;
            ParticleEmitter emitter = steady(100);
            emitter.bursts = {{.time = 0.05f, .count = 10}};
            emitter.duration = 0.5f;
            emitter.capacity = 5000;
            ParticleMotion motion;
            motion.turbulence = 1;
            float* const fields[] = {
                &emitter.rate, &emitter.rate_spread,   &emitter.life,     &emitter.speed,
                &emitter.cone, &emitter.size.y,        &emitter.duration, &emitter.bursts[0].count,
                &motion.drag,  &motion.turbulence_size};
            emitter.shape = EmitterShape::Ball;
            *fields[field] = bad;
            scene.add(emitter, motion);
            scene.run(40);
            const ParticlePool& pool = scene.pool();
            REQUIRE(pool.size() <= 5000);
            for (std::size_t i = 0; i < pool.size(); ++i) {
                REQUIRE(
                    std::isfinite(pool.x[i] + pool.y[i] + pool.z[i] + pool.vx[i] + pool.age[i]));
            }
        }
    }
}

TEST_CASE("particles: a step of ten seconds moves them by a tenth of one") {
    Emitters scene(10.0f);
    scene.add(steady(100), falling(0));
    scene.run();
    CHECK(scene.pool().size() == 10);
    CHECK(*std::max_element(scene.pool().y.begin(), scene.pool().y.end()) <= 0.1f);
}
