#include "systems/particles/particle_kernels.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::particle_kernels_test {

using namespace limn::test;

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
            .old_weight = 0.3f};
        apply_turbulence(particle_block(a, 0, count), noise, 0.02f);
        apply_turbulence_scalar(particle_block(b, 0, count), noise, 0.02f);
        CHECK(same_bits(a, b));
        const std::size_t dead = move_particles(particle_block(a, 0, count), step);
        CHECK(dead == move_particles_scalar(particle_block(b, 0, count), step));
        CHECK(same_bits(a, b));
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

TEST_CASE(
    "particles: wrapping by vectors gives the bits of the plain loop"
    * technique("engine.space-dust")) {
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

}  // namespace limn::particle_kernels_test
