#include "bench/particles/hand_written_particles.h"
#include "bench/particles/particle_race.h"
#include "bench/particles/particle_rows.h"
#include "render/particles/particle_list.h"
#include "systems/particles/particle_births.h"
#include "systems/particles/particle_contacts.h"
#include "systems/particles/particle_deaths.h"

#include <fmt/format.h>
#include <glm/packing.hpp>

#include <algorithm>
#include <cstring>
#include <utility>

// Motion, births, deaths, noise and packing of the pools of the CPU. Color and size over the life
// cost the update nothing: the vertex shader evaluates them from the fraction of the life.

namespace limn::bench {
namespace {

constexpr ParticleStep kFall = {.gravity = {0, -9.81f, 0}, .keep = 0.99f, .dt = kStep};

std::string named(const char* what, std::size_t count) {
    return fmt::format(
        "{}, {}", what,
        count >= 1000000 ? fmt::format("{}M", count / 1000000) : fmt::format("{}k", count / 1000));
}

void add_motion_rows(
    ParticleBench& bench, std::size_t count, double arrays_limit, double structures_limit) {
    ParticlePool ours = make_pool(count);
    ParticlePool bare = make_pool(count);
    Structures structures(count);
    const auto move = [&] { move_particles(particle_block(ours, 0, count), kFall); };
    const std::string name = named("motion, drag, age", count);
    const auto [moved, arrays] =
        race(count, kUnprepared, move, kUnprepared, [&] { step_arrays(bare); });
    const char* const number = count == 10000 ? "1" : count == 100000 ? "2" : "3";
    bench.add(GateRow{number, name, moved, arrays, "six arrays, gravity", "ns", arrays_limit});
    const auto [again, all] =
        race(count, kUnprepared, move, kUnprepared, [&] { structures.step(); });
    bench.add(GateRow{number, name, again, all, "structures, all modules", "ns", structures_limit});
    const auto blocks = [&] {
        for (std::size_t first = 0; first < count; first += kParticleBlock) {
            move_particles(
                particle_block(ours, first, std::min<std::size_t>(count - first, kParticleBlock)),
                kFall);
        }
    };
    const auto [by_block, whole] = race(count, kUnprepared, blocks, kUnprepared, move);
    bench.add(GateRow{
        "4", named("motion by blocks of 1,024", count), by_block, whole, "the whole at once", "ns",
        1.1});
}

void add_birth_rows(ParticleBench& bench) {
    constexpr std::size_t kCount = 10000;
    ParticleEmitter emitter;
    emitter.shape = EmitterShape::Ball;
    emitter.capacity = kCount;
    const std::vector<BirthRun> births = {{.first = 0.5f, .count = kCount}};
    ParticlePool pool;
    const auto clear = [&] {
        for (auto* column :
             {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz, &pool.age, &pool.life}) {
            column->clear();
        }
        pool.look.clear();
    };
    const auto bear = [&] {
        add_particles(emitter, {}, {.dt = kStep}, nullptr, 1, 2, births, pool);
    };
    ParticlePool bare = make_pool(kCount);
    const auto [born, arrays] = race(kCount, clear, bear, kUnprepared, [&] { step_arrays(bare); });
    bench.add(GateRow{"7", "birth in a ball, 10k", born, arrays, "six arrays, gravity", "ns", 6});
    BirthColumns columns(kCount);
    const auto [again, xorshift] = race(kCount, clear, bear, kUnprepared, [&] { columns.fill(); });
    bench.add(GateRow{
        "7", "birth in a ball, 10k", again, xorshift, "eleven columns, xorshift", "ns", 0.125});
}

void add_death_rows(ParticleBench& bench) {
    for (const auto& [count, limit] :
         {std::pair<std::size_t, double>{10000, 0.6}, {1000000, 0.9}}) {
        ParticlePool all = make_pool(count);
        kill_every(all, 100);
        ParticlePool pool;
        ParticlePool bare = make_pool(count);
        const auto [removed, arrays] = race(
            count, [&] { pool = all; }, [&] { remove_dead(pool, 0); }, kUnprepared,
            [&] { step_arrays(bare); });
        bench.add(GateRow{
            "8", named("1 % deaths, out of order", count), removed, arrays, "six arrays, gravity",
            "ns", limit});
    }
    for (const std::size_t count : {10000, 100000, 1000000}) {
        ParticlePool all = make_pool(count);
        kill_every(all, 10);
        ParticlePool pool;
        ParticlePool other;
        const auto [removed, rows] = race(
            count, [&] { pool = all; }, [&] { remove_dead_in_order(pool, 0); },
            [&] { other = all; }, [&] { remove_dead_in_order_scalar(other, 0); });
        bench.add(GateRow{
            "9", named("10 % deaths, in order", count), removed, rows, "row by row", "ns", 0.4});
    }
}

void add_noise_rows(ParticleBench& bench) {
    constexpr std::size_t kCount = 100000;
    ParticlePool pool = make_pool(kCount);
    ParticlePool bare = make_pool(kCount);
    const auto stir = [&] {
        apply_turbulence(particle_block(pool, 0, kCount), Turbulence{}, 1e-6f);
    };
    const auto [stirred, arrays] =
        race(kCount, kUnprepared, stir, kUnprepared, [&] { step_arrays(bare); });
    bench.add(GateRow{"16", "curl noise, 100k", stirred, arrays, "six arrays, gravity", "ns", 8});
    const auto [again, scalar] = race(kCount, kUnprepared, stir, kUnprepared, [&] {
        apply_turbulence_scalar(particle_block(bare, 0, kCount), Turbulence{}, 1e-6f);
    });
    bench.add(GateRow{"16", "curl noise, 100k", again, scalar, "without SIMD", "ns", 0.2});
}

/// Instances of 28 bytes, one after another: the obvious implementation.
void pack_by_hand(const ParticlePool& pool, float back, std::vector<ParticleInstance>& instances) {
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const float age = pool.age[i] - back;
        const Vec3 velocity = {pool.vx[i], pool.vy[i], pool.vz[i]};
        const float fraction = std::clamp(age / pool.life[i], 0.0f, 1.0f);
        ParticleInstance& instance = instances[i];
        instance.position = Vec3(pool.x[i], pool.y[i], pool.z[i]) - velocity * back;
        instance.look_and_life = static_cast<std::uint32_t>(fraction * 65535.0f);
        instance.velocity_xy = glm::packHalf2x16(Vec2(velocity));
        instance.velocity_z_age = glm::packHalf2x16(Vec2(velocity.z, age));
        instance.random = pool.look[i];
    }
}

void add_packing_rows(ParticleBench& bench) {
    for (const std::size_t count : {10000, 100000, 1000000}) {
        const ParticlePool pool = make_pool(count);
        std::vector<ParticleInstance> instances;
        std::vector<ParticleInstance> by_hand(count);
        const auto [packed, scalar] = race(
            count, [&] { instances.clear(); },
            [&] { append_particles(pool, 0, 0.001f, instances); }, kUnprepared,
            [&] { pack_by_hand(pool, 0.001f, by_hand); });
        bench.add(GateRow{
            "17", named("packing for the GPU", count), packed, scalar, "one after another", "ns",
            0.55});
    }
}

void add_copy_row(ParticleBench& bench) {
    constexpr std::size_t kCount = 1000000;
    constexpr std::size_t kBytes = 60;  // 32 read, 28 written
    ParticlePool pool = make_pool(kCount);
    std::vector<char> from(kCount * kBytes / 2, 1);
    std::vector<char> to(from.size());
    const auto [moved, copied] = race(
        kCount, kUnprepared, [&] { move_particles(particle_block(pool, 0, kCount), kFall); },
        kUnprepared, [&] { std::memcpy(to.data(), from.data(), from.size()); });
    bench.add(GateRow{
        "", "motion, drag, age, 1M: bytes as fast as a copy's", moved, copied,
        "memcpy of as many bytes", "ns", 1 / 0.6});
}

}  // namespace

void add_update_rows(ParticleBench& bench) {
    add_motion_rows(bench, 10000, 2.5, 0.35);
    add_motion_rows(bench, 100000, 2.5, 1);
    add_motion_rows(bench, 1000000, 1.8, 0.6);
    add_copy_row(bench);
    bench.note("5: color and size over the life are evaluated by the vertex shader, so the update "
               "has no such modules");
    bench.note("6: the kernels have flags of their own, whatever the user's: Highway compiles them "
               "for each machine");
    add_birth_rows(bench);
    add_death_rows(bench);
    add_noise_rows(bench);
    add_packing_rows(bench);
}

void add_growth(ParticleBench& bench, std::size_t most) {
    for (std::size_t count = 1000; count <= most; count *= 10) {
        ParticlePool pool = make_pool(count);
        Structures structures(count);
        const auto [ours, by_hand] = race(
            count, kUnprepared, [&] { move_particles(particle_block(pool, 0, count), kFall); },
            kUnprepared, [&] { structures.step(); });
        bench.add(GrowthPoint{"motion, drag, age", count, ours});
        bench.add(GrowthPoint{"array of structures by hand", count, by_hand});
        bench.add(GrowthPoint{"six arrays by hand", count, best_time(count, kUnprepared, [&] {
                                  step_arrays(pool);
                              })});
        bench.add(GrowthPoint{"curl noise", count, best_time(count, kUnprepared, [&] {
                                  apply_turbulence(
                                      particle_block(pool, 0, count), Turbulence{}, 1e-6f);
                              })});
        ParticlePool dying = pool;
        kill_every(dying, 100);
        bench.add(GrowthPoint{
            "1 % deaths", count,
            best_time(
                count, [&] { pool = dying; }, [&] { remove_dead(pool, 0); })});
        std::vector<ParticleInstance> instances;
        bench.add(GrowthPoint{
            "packing for the GPU", count,
            best_time(
                count, [&] { instances.clear(); },
                [&] { append_particles(dying, 0, 0.001f, instances); })});
    }
}

}  // namespace limn::bench
