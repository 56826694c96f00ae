#pragma once

#include "ecs/base/rng.h"
#include "ecs/components/particles.h"
#include "systems/particles/particle_kernels.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Particles as people write them by hand, to compare with. Files that include this are compiled
// with the flags that suit these loops best (-O3 -march=native).

namespace limn::bench {

inline constexpr float kStep = 1.0f / 60.0f;

/// Gravity and motion over six arrays: the minimum of work.
inline void step_arrays(
    float* __restrict x, float* __restrict y, float* __restrict z, float* __restrict vx,
    float* __restrict vy, float* __restrict vz, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        vy[i] -= 9.81f * kStep;
        x[i] += vx[i] * kStep;
        y[i] += vy[i] * kStep;
        z[i] += vz[i] * kStep;
    }
}

/// A particle of an array of structures.
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

/// All basic modules: gravity, motion, age, color and size over the life by tables of 64 entries.
struct Structures {
    std::vector<Structure> all;
    std::array<std::array<float, 4>, 64> colors = {};
    std::array<float, 64> sizes = {};

    explicit Structures(std::size_t count) : all(count) {
        Random random(1, 2, 3, 4);
        for (Structure& p : all) {
            p = {};
            p.velocity[1] = random.uniform();
            p.age = random.uniform();
            p.life = 2;
            p.first_size = 1;
        }
    }
    void step() {
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
    }
};

/// Eleven columns from six random numbers of xorshift (Marsaglia 2003), one particle after another.
struct BirthColumns {
    std::array<std::vector<float>, 11> columns;
    std::uint32_t state = 2463534242;

    explicit BirthColumns(std::size_t count) {
        for (std::vector<float>& column : columns) {
            column.resize(count);
        }
    }
    float random() {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        return static_cast<float>(state >> 8) * 0x1p-24f;
    }
    void fill() {
        for (std::size_t i = 0; i < columns[0].size(); ++i) {
            for (std::size_t c = 0; c < 6; ++c) {
                columns[c][i] = 2 * random() - 1;
            }
            columns[6][i] = 0;
            columns[7][i] = 2;
            columns[8][i] = 1;
            columns[9][i] = 0.5f;
            columns[10][i] = 0;
        }
    }
};

/// Particles in a cube of 20 m.
[[nodiscard]] inline ParticlePool make_pool(std::size_t count, float life = 1e9f) {
    ParticlePool pool;
    Random random(1, 2, 3, 4);
    for (std::size_t i = 0; i < count; ++i) {
        for (auto* column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
            column->push_back(random.uniform(-10.0f, 10.0f));
        }
        pool.age.push_back(random.uniform());
        pool.life.push_back(life);
        pool.look.push_back(random.word());
    }
    return pool;
}

inline void step_arrays(ParticlePool& p) {
    step_arrays(
        p.x.data(), p.y.data(), p.z.data(), p.vx.data(), p.vy.data(), p.vz.data(), p.size());
}

/// Every `interval`-th is dead.
inline void kill_every(ParticlePool& pool, std::size_t interval) {
    for (std::size_t i = 0; i < pool.size(); i += interval) {
        pool.life[i] = 0;
    }
}

}  // namespace limn::bench
