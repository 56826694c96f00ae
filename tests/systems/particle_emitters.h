#pragma once

#include "ecs/base/rng.h"
#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/weather.h"
#include "ecs/world.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/particle_system.h"

#include <cstddef>
#include <vector>

namespace limn::test {

inline constexpr float kStep = 1.0f / 60.0f;

/// A world with emitters at rest.
struct Emitters {
    World world;
    std::vector<Entity> entities;

    explicit Emitters(float step = kStep) {
        register_all_components();
        world.insert_resource(FrameTime{.step = step});
        world.insert_resource(RandomSeed{});
        world.insert_resource(WeatherState{});
        world.insert_resource(Assets{});
        world.insert_resource(ParticleObstacles{});
    }
    Entity add(const ParticleEmitter& emitter, const ParticleMotion& motion = {}) {
        entities.push_back(
            world.create(emitter, motion, WorldTransform{}, PreviousWorldTransform{Affine{}}));
        world.run(add_particle_pools);
        return entities.back();
    }
    void run(int steps = 1) {
        for (int i = 0; i < steps; ++i) {
            FrameTime& time = world.resource<FrameTime>();
            time.time += static_cast<double>(time.step);
            ++time.frame;
            world.run(find_particle_obstacles);
            world.run(update_particles);
        }
    }
    const ParticlePool& pool(std::size_t i = 0) {
        return world.get<const ParticlePool>(entities[i]);
    }
};

/// Births at a point, straight up, that do not end.
inline ParticleEmitter steady(float rate) {
    ParticleEmitter emitter;
    emitter.rate = rate;
    emitter.cone = 0;
    emitter.speed = 1;
    emitter.speed_spread = 0;
    emitter.life = 1000;
    emitter.life_spread = 0;
    emitter.capacity = 1000000;
    emitter.executor = ParticleExecutor::Cpu;
    return emitter;
}

inline ParticleEmitter burst(float count) {
    ParticleEmitter emitter = steady(0);
    emitter.bursts = {{.time = 0, .count = count}};
    return emitter;
}

inline ParticleMotion falling(float gravity = 1) {
    ParticleMotion motion;
    motion.gravity = gravity;
    return motion;
}

/// A pool of particles anywhere, some of them dead.
inline ParticlePool random_pool(std::size_t count) {
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

inline bool same_bits(const ParticlePool& a, const ParticlePool& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.vx == b.vx && a.vy == b.vy && a.vz == b.vz
           && a.age == b.age && a.life == b.life && a.look == b.look && a.stuck == b.stuck
           && a.clock.born == b.clock.born;
}

}  // namespace limn::test
