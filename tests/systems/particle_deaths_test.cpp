#include "ecs/components/trail.h"
#include "ecs/snapshot.h"
#include "systems/particles/particle_deaths.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace limn::particle_deaths_test {

using namespace limn::test;

namespace {

/// The random bits of those that live, and of the first ones in any case.
std::vector<std::uint32_t> looks_of_living(const ParticlePool& pool, std::size_t first) {
    std::vector<std::uint32_t> looks;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        if (i < first || pool.age[i] < pool.life[i]) {
            looks.push_back(pool.look[i]);
        }
    }
    return looks;
}

/// Every row of random_pool() sticks as its look says.
bool rows_are_whole(const ParticlePool& pool) {
    bool whole = pool.stuck.size() == pool.size();
    for (std::size_t i = 0; whole && i < pool.size(); ++i) {
        whole = pool.stuck[i] == (pool.look[i] & 1);
    }
    return whole;
}

/// Births all the time, of which some die early.
ParticleEmitter restless() {
    ParticleEmitter emitter = steady(2000);
    emitter.life = 0.3f;
    emitter.life_spread = 0.25f;
    return emitter;
}

bool is_oldest_first(const ParticlePool& pool) {
    return std::is_sorted(pool.age.begin(), pool.age.end(), std::greater<>());
}

}  // namespace

TEST_CASE("particle deaths: vectors give the bits of the plain loops, for any number") {
    for (const std::size_t count : {0u, 1u, 7u, 16u, 33u, 1000u, 16384u, 40001u}) {
        for (const std::size_t first : {std::size_t{0}, count / 3}) {
            CAPTURE(count);
            ParticlePool a = random_pool(count);
            ParticlePool b = a;
            CHECK(remove_dead(a, first) == remove_dead_scalar(b, first));
            CHECK(same_bits(a, b));
            ParticlePool c = random_pool(count);
            ParticlePool d = c;
            CHECK(remove_dead_in_order(c, first) == remove_dead_in_order_scalar(d, first));
            CHECK(same_bits(c, d));
        }
    }
}

TEST_CASE("particle deaths: in order, the others keep their order") {
    ParticlePool pool = random_pool(500);
    const std::vector<std::uint32_t> expected = looks_of_living(pool, 100);
    REQUIRE(expected.size() < 450);
    remove_dead_in_order(pool, 100);
    CHECK(pool.look == expected);
    CHECK(rows_are_whole(pool));
    CHECK_FALSE(pool.mixed);
}

TEST_CASE(
    "particle deaths: out of order, all that live stay and only the last ones move"
    * technique("particle.system")) {
    for (const std::size_t count : {500u, 40001u}) {
        ParticlePool pool = random_pool(count);
        const ParticlePool before = pool;
        std::vector<std::uint32_t> expected = looks_of_living(pool, 100);
        const std::size_t left = remove_dead(pool, 100);
        REQUIRE(left == expected.size());
        CHECK(rows_are_whole(pool));
        CHECK(pool.mixed);
        for (std::size_t i = 0; i < left; ++i) {
            const bool lived = i < 100 || before.age[i] < before.life[i];
            REQUIRE((!lived || pool.look[i] == before.look[i]));
        }
        std::vector<std::uint32_t> found = pool.look;
        std::sort(found.begin(), found.end());
        std::sort(expected.begin(), expected.end());
        CHECK(found == expected);
    }
}

TEST_CASE("particle deaths: a pool that lost all its particles is not mixed") {
    ParticlePool pool = random_pool(50);
    std::fill(pool.life.begin(), pool.life.end(), 0.0f);
    CHECK(remove_dead(pool, 0) == 0);
    CHECK_FALSE(pool.mixed);
}

TEST_CASE("particle deaths: a mixed pool comes back into the order of ages, rows whole") {
    ParticlePool pool = random_pool(1000);
    remove_dead(pool, 0);
    std::vector<std::uint32_t> before = pool.look;
    restore_order(pool);
    CHECK(is_oldest_first(pool));
    CHECK(rows_are_whole(pool));
    CHECK_FALSE(pool.mixed);
    std::vector<std::uint32_t> after = pool.look;
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    CHECK(after == before);
}

TEST_CASE(
    "particle deaths: order is kept only where something depends on it"
    * technique("particle.system")) {
    Emitters scene;
    const Entity plain = scene.add(restless());
    const Entity births = scene.add(restless());
    ParticleLook look;
    look.sort = ParticleSort::Births;
    scene.world.add(births, look);
    const Entity depth = scene.add(restless());
    look.sort = ParticleSort::Distance;
    scene.world.add(depth, look);
    const Entity lights = scene.add(restless());
    scene.world.add(lights, ParticleLight{});
    const Entity ribbon = scene.add(restless());
    scene.world.add(ribbon, Trail{.path = TrailPath::Births});
    const Entity trails = scene.add(restless());
    scene.world.create(Trail{.path = TrailPath::Particles, .emitter = trails});
    const Entity meshes = scene.add(restless());
    scene.world.add(meshes, ParticleMesh{});
    const Entity parent = scene.add(restless());
    scene.world.create(
        steady(0), ParticleSource{.emitter = parent}, WorldTransform{},
        PreviousWorldTransform{Affine{}});
    ParticleEmitter window = restless();
    window.population = ParticlePopulation::Linear;
    const Entity linear = scene.add(window);
    scene.run(60);
    for (const Entity entity : {births, lights, ribbon, trails, meshes, parent, linear}) {
        CAPTURE(entity.index);
        CHECK(is_oldest_first(scene.world.get<const ParticlePool>(entity)));
    }
    for (const Entity entity : {plain, depth}) {
        CHECK_FALSE(is_oldest_first(scene.world.get<const ParticlePool>(entity)));
    }
}

TEST_CASE("particle deaths: particles get the order back when a ribbon begins to follow them") {
    Emitters scene;
    const Entity entity = scene.add(restless());
    scene.run(60);
    CHECK(scene.pool().mixed);
    scene.world.add(entity, Trail{.path = TrailPath::Births});
    scene.run(1);
    CHECK_FALSE(scene.pool().mixed);
    CHECK(is_oldest_first(scene.pool()));
}

TEST_CASE("particle deaths: a mixed pool that is restored goes on with the same bits") {
    Emitters scene;
    scene.add(restless());
    scene.run(60);
    REQUIRE(scene.pool().mixed);
    const Result<std::vector<std::byte>> saved = save_snapshot(scene.world);
    REQUIRE(saved.ok());
    scene.run(30);
    const std::uint64_t expected = state_hash(scene.world);
    const ParticlePool went_on = scene.pool();
    REQUIRE(restore_snapshot(scene.world, *saved).ok());
    CHECK(scene.pool().mixed);
    scene.run(30);
    CHECK(same_bits(scene.pool(), went_on));
    CHECK(state_hash(scene.world) == expected);
}

}  // namespace limn::particle_deaths_test
