#include "ecs/base/rng.h"
#include "render/particles/particle_packing.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <vector>

namespace limn::particle_packing_test {
namespace {

/// Some are not born yet, some have outlived their time, one has no life.
ParticlePool make_pool(std::size_t count) {
    ParticlePool pool;
    Random random(1, 2, 3, 4);
    for (std::size_t i = 0; i < count; ++i) {
        for (auto* column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(random.uniform(-10.0f, 10.0f));
        }
        pool.age.push_back(random.uniform(-0.01f, 1.2f));
        pool.life.push_back(i == 70 ? 0.0f : 1.0f);
        pool.look.push_back(random.word());
    }
    return pool;
}

constexpr ParticlePacking kPacking = {.look = 40000, .back = 0.004f, .observer = {1, -2, 3}};

}  // namespace

TEST_CASE("particle packing: vectors pack what the plain loop packs, in its order") {
    for (const std::size_t count : {0, 1, 7, 64, 500}) {
        const ParticlePool pool = make_pool(count);
        std::vector<ParticleInstance> ours(count);
        std::vector<ParticleInstance> plain(count);
        const std::size_t packed = pack_particles(pool, kPacking, ours);
        REQUIRE(packed == pack_particles_scalar(pool, kPacking, plain));
        if (count == 500) {
            CHECK(packed < count);
        }
        for (std::size_t i = 0; i < packed; ++i) {
            CHECK(ours[i].position == plain[i].position);
            CHECK(ours[i].look_and_life == plain[i].look_and_life);
            CHECK(ours[i].random == plain[i].random);
            const Vec4 a = ours[i].motion();
            const Vec4 b = plain[i].motion();
            for (int c = 0; c < 4; ++c) {  // ties may be rounded either way
                CHECK(std::abs(a[c] - b[c]) <= std::abs(b[c]) * 0x1p-10f + 0x1p-24f);
            }
        }
    }
}

TEST_CASE("particle packing: the look is above the fraction of the life, velocities are relative") {
    ParticlePool pool = make_pool(32);
    pool.age.assign(32, 0.504f);
    pool.life.assign(32, 1.0f);
    pool.vx.assign(32, 3);
    std::vector<ParticleInstance> instances(32);
    REQUIRE(pack_particles(pool, kPacking, instances) == 32);
    for (const ParticleInstance& instance : instances) {
        CHECK((instance.look_and_life >> 16) == 40000);
        CHECK((instance.look_and_life & 0xffff) == 32767);
        CHECK(instance.motion().x == 2);
    }
}

}  // namespace limn::particle_packing_test
