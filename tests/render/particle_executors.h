#pragma once

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_balls.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/trail.h"
#include "ecs/components/weather.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/particle_list.h"
#include "systems/particles/gpu_particle_system.h"
#include "systems/particles/particle_balls_system.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/particle_system.h"
#include "tests/render/scene_fixture.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace limn::test {

struct GpuParticle {
    Vec4 position_age;
    Vec4 velocity_life;
};

/// The same emitter twice, moved by the CPU and by the GPU.
struct Executors : Scene {
    Entity cpu;
    Entity gpu;
    GpuParticlePools pools = *GpuParticlePools::create(device());
    FrameGraph graph{device()};

    Executors(ParticleEmitter emitter, const ParticleMotion& motion) {
        world.insert_resource(FrameTime{});
        world.insert_resource(RandomSeed{});
        world.insert_resource(WeatherState{});
        world.insert_resource(ParticleObstacles{});
        world.insert_resource(GpuShapes{});
        emitter.seed = 5;  // of both
        const Affine at = affine_from({1, 2, 3}, Quat(0.9f, 0.1f, 0.2f, -0.3f), Vec3(1));
        for (Entity* const entity : {&cpu, &gpu}) {
            emitter.executor = entity == &cpu ? ParticleExecutor::Cpu : ParticleExecutor::Gpu;
            *entity = world.create(emitter, motion, WorldTransform{at}, PreviousWorldTransform{at});
        }
        world.create(Trail{.path = TrailPath::Births, .emitter = cpu});  // so: oldest first
        world.run(add_particle_pools);
        world.run(add_gpu_particles);
    }
    void step(int steps = 1) {
        for (int i = 0; i < steps; ++i) {
            FrameTime& time = world.resource<FrameTime>();
            time.time += static_cast<double>(time.step);
            ++time.frame;
            world.run(find_particle_obstacles);
            world.run(update_particles);
            world.run(update_particle_balls);
            world.run(record_gpu_particles);
        }
    }
    GpuParticles& recorded() { return world.get<GpuParticles>(gpu); }
    const ParticlePool& pool() { return world.get<const ParticlePool>(cpu); }
    void collide(const ParticleCollision& collision) {
        world.add(cpu, collision);
        world.add(gpu, collision);
    }
    void add_obstacle(
        const ParticleCollider& collider, const Vec3& position,
        const Quat& rotation = Quat(1, 0, 0, 0)) {
        const Affine at = affine_from(position, rotation, Vec3(1));
        world.create(collider, WorldTransform{at}, PreviousWorldTransform{at});
    }
    /// Lets the GPU catch up, and reads those that may be alive, oldest first.
    std::vector<GpuParticle> read(bool paced = false) {
        FrameData frame;
        frame.ring = &ring;
        ring.begin_frame();
        pools.begin_frame(world);
        pools.add(
            frame, gpu, world.get<const ParticleEmitter>(gpu), recorded(), 0, std::nullopt,
            world.find<ParticleCollision>(gpu), 1, world.find<ParticleBalls>(gpu), paced);
        graph.begin_frame();
        pools.update(graph, {});
        graph.execute();
        ring.end_frame();
        const GpuParticlePool& pool = *pools.pools().begin()->second;
        std::vector<GpuParticle> slots(pool.capacity);
        pool.state.read(0, std::as_writable_bytes(std::span(slots)));
        std::vector<GpuParticle> alive;
        for (std::uint32_t i = 0; i < pool.count; ++i) {
            const GpuParticle& one = slots[(pool.first + i) % pool.capacity];
            if (one.position_age.w < std::abs(one.velocity_life.w)) {
                alive.push_back(one);
            }
        }
        return alive;
    }
    /// What the last read() has written for drawing.
    std::vector<ParticleInstance> drawn() {
        const GpuParticlePool& pool = *pools.pools().begin()->second;
        std::vector<ParticleInstance> instances(pool.count);
        pool.instances.read(0, std::as_writable_bytes(std::span(instances)));
        return instances;
    }
    gpu::RingBuffer ring{device().caps(), "steps", 1 << 20};
};

/// Largest distance between particles of the same number, as a fraction of how far they may have
/// come.
inline float
largest_distance(const std::vector<GpuParticle>& gpu, const ParticlePool& cpu, float range) {
    float largest = 0;
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        const Vec3 position = {cpu.x[i], cpu.y[i], cpu.z[i]};
        largest = std::max(largest, glm::distance(Vec3(gpu[i].position_age), position) / range);
    }
    return largest;
}

/// 400 particles per second for 12 s.
inline ParticleEmitter fountain() {
    ParticleEmitter emitter;
    emitter.rate = 400;
    emitter.capacity = 4096;
    emitter.life = 12;
    emitter.life_spread = 0;
    emitter.speed = 3;
    return emitter;
}

/// Out of a ball in all directions, at one speed [m/s].
inline ParticleEmitter outburst(float speed) {
    ParticleEmitter emitter = fountain();
    emitter.shape = EmitterShape::Ball;
    emitter.size = Vec3(0.5f);
    emitter.speed = speed;
    emitter.speed_spread = 0;
    emitter.cone = kPi;
    return emitter;
}

}  // namespace limn::test
