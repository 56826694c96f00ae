#include "ecs/base/rng.h"
#include "systems/particles/particle_births.h"
#include "systems/particles/particle_kernels.h"

#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <vector>

// A step of particles against the loops that people write by hand, compiled with the flags that
// suit those best (-O3 -march=native):
//
//     arrays      gravity and motion over six arrays, restrict pointers: the least that can be done
//     structures  an array of structures of 72 bytes with color and size from tables of 64 entries

namespace {

using namespace limn;

constexpr float kStep = 1.0f / 60.0f;

void per_particle(benchmark::State& state) {
    state.counters["per_particle"] = benchmark::Counter(
        static_cast<double>(state.range(0)),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert,
        benchmark::Counter::kIs1000);
}

ParticlePool make_pool(std::int64_t count, float life = 1e9f) {
    ParticlePool pool;
    Random random(1, 2, 3, 4);
    for (std::int64_t i = 0; i < count; ++i) {
        for (auto* column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(random.uniform(-10.0f, 10.0f));
        }
        pool.age.push_back(random.uniform());
        pool.life.push_back(life);
        pool.look.push_back(random.word());
    }
    return pool;
}

void step_arrays(
    float* __restrict x, float* __restrict y, float* __restrict z, float* __restrict vx,
    float* __restrict vy, float* __restrict vz, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        vy[i] -= 9.81f * kStep;
        x[i] += vx[i] * kStep;
        y[i] += vy[i] * kStep;
        z[i] += vz[i] * kStep;
    }
}

void arrays(benchmark::State& state) {
    ParticlePool p = make_pool(state.range(0));
    for (auto _ : state) {
        step_arrays(
            p.x.data(), p.y.data(), p.z.data(), p.vx.data(), p.vy.data(), p.vz.data(), p.size());
        benchmark::ClobberMemory();
    }
    per_particle(state);
}

struct Structure {
    float position[3];
    float velocity[3];
    float age, life;
    float color[4];
    float size, first_size;
    float angle, spin;
    std::uint32_t seed, flags;
};
static_assert(sizeof(Structure) == 72);

void structures(benchmark::State& state) {
    std::vector<Structure> all(static_cast<std::size_t>(state.range(0)));
    Random random(1, 2, 3, 4);
    for (Structure& p : all) {
        p = {};
        p.velocity[1] = random.uniform();
        p.age = random.uniform();
        p.life = 2;
        p.first_size = 1;
    }
    std::array<std::array<float, 4>, 64> colors = {};
    std::array<float, 64> sizes = {};
    for (auto _ : state) {
        for (Structure& p : all) {
            p.velocity[1] -= 9.81f * kStep;
            for (int axis = 0; axis < 3; ++axis) {
                p.position[axis] += p.velocity[axis] * kStep;
            }
            p.age = p.age + kStep < p.life ? p.age + kStep : 0.0f;
            const auto entry = static_cast<std::size_t>(p.age / p.life * 63.0f);
            for (std::size_t c = 0; c < 4; ++c) {
                p.color[c] = colors[entry][c];
            }
            p.size = p.first_size * sizes[entry];
        }
        benchmark::ClobberMemory();
    }
    per_particle(state);
}

template <auto move>
void moved(benchmark::State& state) {
    ParticlePool pool = make_pool(state.range(0));
    const ParticleStep step = {.gravity = {0, -9.81f, 0}, .keep = 0.99f, .dt = kStep};
    for (auto _ : state) {
        benchmark::DoNotOptimize(move(particle_block(pool, 0, pool.size()), step));
    }
    per_particle(state);
}

template <auto stir>
void stirred(benchmark::State& state) {
    ParticlePool pool = make_pool(state.range(0));
    for (auto _ : state) {
        stir(particle_block(pool, 0, pool.size()), Turbulence{}, 1e-6f);
        benchmark::ClobberMemory();
    }
    per_particle(state);
}

/// One in `state.range(1)` is dead.
template <auto remove>
void removed(benchmark::State& state) {
    ParticlePool all = make_pool(state.range(0));
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(state.range(1))) {
        all.life[i] = 0;
    }
    ParticlePool pool;
    for (auto _ : state) {
        state.PauseTiming();
        pool = all;
        state.ResumeTiming();
        benchmark::DoNotOptimize(remove(pool, 0));
    }
    per_particle(state);
}

void born(benchmark::State& state) {
    ParticleEmitter emitter;
    emitter.shape = EmitterShape::Ball;
    emitter.capacity = static_cast<std::uint32_t>(state.range(0));
    const std::vector<BirthRun> births = {
        {.first = 0.5f, .count = static_cast<std::uint32_t>(state.range(0))}};
    ParticlePool pool;
    for (auto _ : state) {
        for (auto* column :
             {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz, &pool.age, &pool.life}) {
            column->clear();
        }
        pool.look.clear();
        add_particles(emitter, {}, {.dt = kStep}, 1, 2, births, pool);
    }
    per_particle(state);
}

void sizes(benchmark::internal::Benchmark* bench) {
    bench->Arg(10000)->Arg(100000)->Arg(1000000);
}
void deaths(benchmark::internal::Benchmark* bench) {
    for (const std::int64_t count : {10000, 100000, 1000000}) {
        bench->Args({count, 100})->Args({count, 10});
    }
}

BENCHMARK(arrays)->Apply(sizes);
BENCHMARK(structures)->Apply(sizes);
BENCHMARK(moved<move_particles>)->Apply(sizes);
BENCHMARK(moved<move_particles_scalar>)->Apply(sizes);
BENCHMARK(stirred<stir_particles>)->Arg(100000);
BENCHMARK(stirred<stir_particles_scalar>)->Arg(100000);
BENCHMARK(removed<remove_dead>)->Apply(deaths);
BENCHMARK(removed<remove_dead_scalar>)->Apply(deaths);
BENCHMARK(born)->Arg(10000)->Arg(100000);

}  // namespace
