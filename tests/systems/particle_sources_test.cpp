#include "ecs/components/particles.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

namespace limn::particle_sources_test {

using namespace limn::test;

namespace {

/// Emitter 0 and one that is born of its particles.
struct Family : Emitters {
    Family(const ParticleEmitter& parent, const ParticleEmitter& child, ParticleSource source) {
        const Entity first = add(parent, falling(0));
        source.emitter = first;
        world.add(add(child, falling(0)), source);
    }
};

}  // namespace

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

}  // namespace limn::particle_sources_test
