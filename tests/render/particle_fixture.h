#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"

#include <span>

namespace limn::test {

/// Particles at `places`, in the middle of their life of a second, all with the same random bits.
inline ParticlePool pool_at(std::span<const Vec3> places, const Vec3& velocity = {0, 0, 0}) {
    ParticlePool pool;
    for (const Vec3& place : places) {
        pool.x.push_back(place.x);
        pool.y.push_back(place.y);
        pool.z.push_back(place.z);
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
