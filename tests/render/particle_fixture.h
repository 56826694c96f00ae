#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"

#include <span>

namespace limn::test {

/// Particles at `positions`, halfway through their life of a second, all with the same random bits.
inline ParticlePool pool_at(std::span<const Vec3> positions, const Vec3& velocity = {0, 0, 0}) {
    ParticlePool pool;
    for (const Vec3& position : positions) {
        pool.x.push_back(position.x);
        pool.y.push_back(position.y);
        pool.z.push_back(position.z);
        pool.vx.push_back(velocity.x);
        pool.vy.push_back(velocity.y);
        pool.vz.push_back(velocity.z);
        pool.age.push_back(0.5f);
        pool.life.push_back(1);
        pool.look.push_back(7);
    }
    return pool;
}

}  // namespace limn::test
