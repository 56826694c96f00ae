#include "bench/particles/particle_race.h"
#include "bench/particles/particle_rows.h"
#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/weather.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "render/particles/particle_list.h"
#include "systems/particles/particle_births.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/particle_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

// Emitters in a world: how the cost depends on their number, on threads and on growth.

namespace limn::bench {
namespace {

constexpr float kStep = 1.0f / 60.0f;

struct Emitters {
    World world;

    Emitters() {
        register_all_components();
        world.insert_resource(FrameTime{.step = kStep});
        world.insert_resource(RandomSeed{});
        world.insert_resource(WeatherState{});
        world.insert_resource(Assets{});
        world.insert_resource(ParticleObstacles{});
    }
    void add(std::size_t emitters, const ParticleEmitter& emitter, const ParticleMotion& motion) {
        for (std::size_t i = 0; i < emitters; ++i) {
            world.create(emitter, motion, WorldTransform{}, PreviousWorldTransform{Affine{}});
        }
        world.run(add_particle_pools);
    }
    void step() {
        FrameTime& time = world.resource<FrameTime>();
        time.time += static_cast<double>(time.step);
        ++time.frame;
        world.run(update_particles);
    }
};

/// All born at once, with long lives.
ParticleEmitter burst_of(std::size_t count) {
    ParticleEmitter emitter;
    emitter.executor = ParticleExecutor::Cpu;
    emitter.rate = 0;
    emitter.bursts = {{.time = 0, .count = static_cast<float>(count)}};
    emitter.capacity = static_cast<std::uint32_t>(count);
    emitter.life = 1e5f;
    emitter.life_spread = 0;
    return emitter;
}

/// Best time of a step, of living particles only [ns each].
double
step_time(std::size_t emitters, std::size_t each, const ParticleMotion& motion, int threads) {
    set_thread_count(threads);
    Emitters all;
    all.add(emitters, burst_of(each), motion);
    all.step();
    return best_time(emitters * each, kUnprepared, [&] { all.step(); });
}

void add_emitter_rows(ParticleBench& bench, int threads) {
    const double one = step_time(1, 100000, {}, threads);
    bench.add(GateRow{
        "23", "1,000 emitters of 100", step_time(1000, 100, {}, threads), one, "one of 100,000",
        "ns", 1.5});
    bench.add(GateRow{
        "23", "10,000 emitters of 10", step_time(10000, 10, {}, threads), one, "one of 100,000",
        "ns", 2.5});
}

void add_thread_rows(ParticleBench& bench, int threads) {
    if (threads < 2) {
        bench.note("25: there is one thread");
        return;
    }
    ParticleMotion stirred;
    stirred.turbulence = 1;
    const double basic = step_time(1, 1000000, {}, 1);
    bench.add(GateRow{
        "25", "1M, two threads", step_time(1, 1000000, {}, 2), basic, "one thread", "ns", 1 / 1.4});
    const double noise = step_time(1, 1000000, stirred, 1);
    bench.add(GateRow{
        "25", "1M with curl noise, two threads", step_time(1, 1000000, stirred, 2), noise,
        "one thread", "ns", 1 / 1.85});
}

/// Equal numbers of births in 60 steps, up to a million: what growing a pool adds to the cost of
/// births. No motion, whose cost grows with the pool. For each step, the best of 20 fillings.
void add_filling_rows(ParticleBench& bench) {
    constexpr std::size_t kSteps = 60;
    constexpr std::uint32_t kCapacity = 1000000;
    constexpr std::uint32_t kBirths = kCapacity / kSteps;
    const ParticleEmitter emitter = burst_of(kCapacity);
    const std::vector<BirthRun> births = {{.first = 0.5f, .count = kBirths}};
    std::vector<double> best(kSteps, INFINITY);
    std::size_t moved = 0;
    for (int repeat = 0; repeat < 20; ++repeat) {
        ParticlePool pool;
        const float* begin = nullptr;
        for (std::size_t i = 0; i < kSteps; ++i) {
            const double time = time_of(
                [&] { add_particles(emitter, {}, {.dt = kStep}, nullptr, 1, 2, births, pool); });
            best[i] = std::min(best[i], time * 1e9 / kBirths);
            moved += i > 0 && pool.x.data() != begin ? i * kBirths : 0;
            begin = pool.x.data();
        }
    }
    bench.add(GateRow{
        "24", "filling a pool to 1M, the slowest step's births",
        *std::max_element(best.begin(), best.end()),
        std::accumulate(best.begin(), best.end(), 0.0) / kSteps, "the mean of its steps", "ns",
        1.5});
    bench.add(GateRow{
        "24", "rows moved by filling a pool to 1M", static_cast<double>(moved), 0, "", "", 0});
}

void add_memory_row(ParticleBench& bench) {
    const ParticlePool pool;
    const std::size_t floats = 8 * sizeof(float);
    const std::size_t bytes = floats + sizeof(pool.look[0]);
    bench.add(GateRow{
        "22", "memory of a particle, simulated and drawn",
        static_cast<double>(bytes + sizeof(ParticleInstance)), 0, "", "B", 64});
}

/// Steps whose state on several threads differs from that on one.
void add_hash_row(ParticleBench& bench) {
    std::vector<std::uint64_t> expected;
    int differing = 0;
    for (const int threads : {1, 2, 3, 7}) {
        set_thread_count(threads);
        Emitters all;
        ParticleEmitter emitter;
        emitter.executor = ParticleExecutor::Cpu;
        emitter.rate = 5000;
        emitter.life = 0.5f;
        ParticleMotion motion;
        motion.turbulence = 2;
        all.add(20, emitter, motion);
        for (std::size_t i = 0; i < 60; ++i) {
            all.step();
            const std::uint64_t hash = state_hash(all.world);
            if (threads == 1) {
                expected.push_back(hash);
            } else {
                differing += hash == expected[i] ? 0 : 1;
            }
        }
    }
    bench.add(GateRow{
        "26", "states that differ on 2, 3 and 7 threads, 60 steps", static_cast<double>(differing),
        0, "", "", 0});
}

/// 20,000 particles at 60 m/s toward a wall 1 mm thick.
void add_tunnel_row(ParticleBench& bench) {
    Emitters all;
    ParticleEmitter emitter = burst_of(20000);
    emitter.shape = EmitterShape::Box;
    emitter.size = {5, 0.5f, 5};
    emitter.speed = -60;
    emitter.speed_spread = 0;
    emitter.cone = 0.5f;
    all.world.create(
        emitter, ParticleMotion{.gravity = 0}, ParticleCollision{.bounce = 0}, WorldTransform{},
        PreviousWorldTransform{Affine{}});
    const Affine wall = affine_from(Vec3(0, -3, 0), Quat(1, 0, 0, 0), Vec3(1));
    all.world.create(
        ParticleCollider{.shape = ColliderShape::Box, .size = {1000, 0.0005f, 1000}},
        WorldTransform{wall}, PreviousWorldTransform{wall});
    all.world.run(add_particle_pools);
    int through = 0;
    for (int i = 0; i < 30; ++i) {
        all.world.run(find_particle_obstacles);
        all.step();
    }
    all.world.query<const ParticlePool>().each([&](const ParticlePool& pool) {
        through = static_cast<int>(
            std::count_if(pool.y.begin(), pool.y.end(), [](float y) { return y < -3.1f; }));
    });
    bench.add(GateRow{
        "27", "of 20,000 at 60 m/s, through a wall of 1 mm", static_cast<double>(through), 0, "",
        "", 0});
}

}  // namespace

void add_world_rows(ParticleBench& bench) {
    const int threads = thread_count();
    add_memory_row(bench);
    add_emitter_rows(bench, 1);
    add_filling_rows(bench);
    add_thread_rows(bench, threads);
    add_hash_row(bench);
    set_thread_count(threads);
    add_tunnel_row(bench);
}

}  // namespace limn::bench
