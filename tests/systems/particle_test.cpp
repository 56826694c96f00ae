#include "ecs/base/jobs.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/snapshot.h"
#include "systems/transform_system.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace limn::particle_test {

using namespace limn::test;

TEST_CASE(
    "particles: as many are alive as are born in a lifetime, and go when it is over"
    * technique("particle.system")) {
    Emitters scene;
    ParticleEmitter emitter = steady(200);
    emitter.life = 1.5f;
    const Entity entity = scene.add(emitter);
    scene.run(300);
    for (int i = 0; i < 60; ++i) {
        scene.run();
        CHECK(std::abs(static_cast<int>(scene.pool().size()) - 300) <= 4);  // those of a step
        const ParticlePool& pool = scene.pool();
        for (std::size_t p = 0; p < pool.size(); ++p) {
            REQUIRE(pool.age[p] < pool.life[p]);
        }
    }
    scene.world.get<ParticleEmitter>(entity).active = false;
    scene.run(91);
    CHECK(scene.pool().size() == 0);
}

TEST_CASE("particles: a full pool drops births and counts them" * technique("particle.system")) {
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

TEST_CASE(
    "particles: a linear population is born once, as many as the capacity"
    * technique("particle.linear-window")) {
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

TEST_CASE(
    "particles: a rate of capacity / life holds the population at the capacity"
    * technique("engine.particle-cpu")) {
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

TEST_CASE(
    "particles: two emitters alike differ, unless they have the same seed"
    * technique("engine.particle-cpu")) {
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

TEST_CASE(
    "particles: threads do not change the bits, nor does a snapshot in between"
    * technique("particle.system")) {
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
    // Emitters without children do their whole step at once.
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
            scene->world.add(added, ParticleLight{});  // in order with and without those
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

TEST_CASE(
    "particles: a step of ten seconds moves them by a tenth of one"
    * technique("particle.system")) {
    Emitters scene(10.0f);
    scene.add(steady(100), falling(0));
    scene.run();
    CHECK(scene.pool().size() == 10);
    CHECK(*std::max_element(scene.pool().y.begin(), scene.pool().y.end()) <= 0.1f);
}

TEST_CASE("particles: without room none is born, and a lifetime of 0 is over at once") {
    Emitters scene;
    ParticleEmitter emitter = steady(6000);
    emitter.bursts = {{.time = 0, .count = 50}};
    emitter.capacity = 0;
    scene.add(emitter);
    emitter.capacity = 500;
    emitter.life = 0;
    scene.add(emitter);
    scene.run(60);
    CHECK(scene.pool(0).size() == 0);
    CHECK(scene.pool(0).clock.born == 0);
    CHECK(scene.pool(0).clock.dropped == 6050);
    CHECK(scene.pool(1).size() == 0);
    CHECK(scene.pool(1).clock.born == 6050);
    CHECK(scene.pool(1).clock.dropped == 0);
}

TEST_CASE("particles: an emitter without a transform has none, one that lost its parent goes on") {
    Emitters scene;
    const Entity nowhere = scene.world.create(steady(600));
    scene.world.run(add_particle_pools);
    const Entity parent = scene.world.create(Transform{.position = {5, 0, 0}});
    const Entity child =
        scene.world.create(steady(600), falling(0), Transform{.position = {1, 2, 0}});
    REQUIRE(set_parent(scene.world, child, parent).ok());
    const auto run = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            scene.world.run(add_world_transforms);
            scene.world.run(add_particle_pools);
            scene.world.run(update_transforms);
            scene.run();
        }
    };
    run(10);
    CHECK(scene.world.get<const ParticlePool>(nowhere).size() == 0);
    CHECK(scene.world.get<const ParticlePool>(child).size() == 100);
    CHECK(scene.world.get<const ParticlePool>(child).x.back() == 6.0f);
    scene.world.destroy(parent);
    run(10);
    const ParticlePool& pool = scene.world.get<const ParticlePool>(child);
    REQUIRE(pool.size() == 200);
    for (std::size_t i = 0; i < 200; ++i) {
        CHECK(pool.x[i] >= 1.0f);
        CHECK(pool.x[i] <= 6.0f);
        if (i < 100 || i >= 110) {  // it has become a root, at its own transform, within a step
            CHECK(pool.x[i] == (i < 100 ? 6.0f : 1.0f));
        }
    }
}

}  // namespace limn::particle_test
