#include "systems/particles/particle_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/particles/particle_births.h"
#include "systems/particles/particle_deaths.h"
#include "systems/particles/particle_kernels.h"
#include "systems/particles/particle_motion.h"
#include "systems/particles/particle_sources.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

// Techniques: particle.system

namespace limn {
namespace {

constexpr std::size_t kEmittersPerJob = 64;       ///< of independent ones
constexpr std::uint32_t kParticlesPerJob = 4096;  ///< at least: small emitters share a job

// ---- independent emitters: all phases at once ----

/// Reuses the motion of the previous emitter: many have the same settings.
class MotionCache {
  public:
    explicit MotionCache(const StepContext& context) : context_(context) {}

    /// Valid until the next call.
    const MotionStep& find(const EmitterRow& row) {
        static const ParticleMotion kDefaultMotion;
        const ParticleMotion& settings = row.motion != nullptr ? *row.motion : kDefaultMotion;
        // Compares bytes: a difference in padding only costs time.
        if (!is_filled_ || std::memcmp(&settings, &settings_, sizeof(settings)) != 0) {
            step_ = find_emitter_motion(&settings, row.wrap, row.now->world, context_);
            std::memcpy(&settings_, &settings, sizeof(settings));
            is_filled_ = true;
            return step_;
        }
        if (depends_on_transform()) {
            orient_motion(step_, row.now->world);
        }
        set_wrap(step_, row.wrap, context_);
        return step_;
    }

  private:
    [[nodiscard]] bool depends_on_transform() const {
        return step_.vortex.around != 0 || step_.vortex.toward != 0 || step_.steering.orbit > 0
               || step_.steering.loss > 0;
    }

    const StepContext& context_;
    bool is_filled_ = false;
    ParticleMotion settings_;
    MotionStep step_;
};
static_assert(std::is_trivially_copyable_v<ParticleMotion>);

void step_independent(const EmitterRow& row, const StepContext& context, MotionCache& motions) {
    const MotionStep& motion = motions.find(row);
    ParticlePool& pool = *row.pool;
    if (!is_unused(pool.clock) && has_no_births(*row.emitter, context.dt, pool.clock)) {
        pool.clock.time += static_cast<double>(context.dt);
        pool.fresh = 0;
    } else {
        EmitterStep step = make_emitter_step(row, motion, context);
        emit_particles(step, context);
    }
    pool.stuck.clear();
    if (move_block(motion, particle_block(pool, 0, pool.size())) > 0) {
        remove_dead(row, 0);
    }
}

void step_independent_emitters(std::span<const EmitterRow> emitters, const StepContext& context) {
    parallel_for(emitters.size(), kEmittersPerJob, [&](std::size_t begin, std::size_t end) {
        MotionCache motions(context);
        for (const EmitterRow& row : emitters.subspan(begin, end - begin)) {
            step_independent(row, context, motions);
        }
    });
}

// ---- the phases of all others ----

/// Some of the particles of an emitter, which move as one piece of work.
struct MovedBlock {
    std::uint32_t emitter = 0;  ///< index of its EmitterStep
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t dead = 0;
    std::vector<ParticleHit> hits = {};
};

void emit_all(std::span<EmitterStep> emitters, const StepContext& context) {
    parallel_for(emitters.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (EmitterStep& step : emitters.subspan(begin, end - begin)) {
            emit_particles(step, context);
        }
    });
}

/// Sizes the flags of stuck particles; empty where particles do not stick.
void resize_stuck(std::span<const EmitterStep> emitters) {
    for (const EmitterStep& step : emitters) {
        ParticlePool& pool = *step.row.pool;
        pool.stuck.resize(step.sticks() ? pool.size() : 0);
    }
}

std::vector<MovedBlock> split_into_blocks(std::span<const EmitterStep> emitters) {
    std::vector<MovedBlock> blocks;
    for (std::uint32_t e = 0; e < emitters.size(); ++e) {
        const auto size = static_cast<std::uint32_t>(emitters[e].row.pool->size());
        for (std::uint32_t first = 0; first < size; first += kParticleBlock) {
            MovedBlock block;
            block.emitter = e;
            block.first = first;
            block.count = std::min<std::uint32_t>(size - first, kParticleBlock);
            blocks.push_back(std::move(block));
        }
    }
    return blocks;
}

/// Groups consecutive blocks into jobs and returns the end of each; the same for any number of
/// threads.
std::vector<std::size_t> split_into_jobs(std::span<const MovedBlock> blocks) {
    std::vector<std::size_t> ends;
    std::uint32_t particles = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        particles += blocks[i].count;
        if (particles >= kParticlesPerJob || i + 1 == blocks.size()) {
            ends.push_back(i + 1);
            particles = 0;
        }
    }
    return ends;
}

/// Moves the particles of a block, counts the dead and records the hits.
void move_block(
    const EmitterStep& step, const ParticleSurroundings& surroundings, MovedBlock& block) {
    ParticlePool& pool = *step.row.pool;
    if (step.row.collision != nullptr && !surroundings.is_empty()) {
        block.dead = move_colliding_particles(
            step.motion, *step.row.collision, surroundings, pool, block.first, block.count,
            block.hits);
    } else {
        block.dead = static_cast<std::uint32_t>(
            move_block(step.motion, particle_block(pool, block.first, block.count)));
    }
}

void move_all(
    std::span<const EmitterStep> emitters, const ParticleSurroundings& surroundings,
    std::span<MovedBlock> blocks) {
    const std::vector<std::size_t> ends = split_into_jobs(blocks);
    parallel_for(ends.size(), 1, [&](std::size_t job, std::size_t) {
        for (std::size_t i = job == 0 ? 0 : ends[job - 1]; i < ends[job]; ++i) {
            move_block(emitters[blocks[i].emitter], surroundings, blocks[i]);
        }
    });
}

/// Hits of each emitter in the order of its particles, and the ripples of those on water.
void collect_hits(
    std::span<const MovedBlock> blocks, const ParticleSurroundings& surroundings,
    Query<RippleState>& ripples, std::span<EmitterStep> emitters) {
    for (const MovedBlock& block : blocks) {
        std::vector<ParticleHit>& hits = emitters[block.emitter].hits;
        hits.insert(hits.end(), block.hits.begin(), block.hits.end());
        add_ripples(block.hits, surroundings, ripples);
    }
}

/// Births by the particles of a parent, which have moved and whose dead are still there. They are
/// added once all dead are removed: a parent may be a child itself.
void find_spawns(EmitterSteps& steps, const StepContext& context) {
    constexpr std::uint32_t kSpawns = name_hash("particle sources");
    parallel_for(steps.children.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            EmitterStep& child = steps.others[steps.children[i]];
            const ParticleEmitter& emitter = *child.row.emitter;
            if (child.parent == kNoParent || !emitter.active) {
                continue;
            }
            const EmitterStep& parent = steps.others[child.parent];
            ParticlePool& pool = *child.row.pool;
            const std::size_t room = birth_room(emitter, pool.size(), pool.clock);
            Random random(context.seed, child.row.subject(), kSpawns, context.time.frame);
            pool.clock.dropped += find_spawns(
                *child.row.source, emitter, *parent.row.pool, parent.hits, context.dt, room, random,
                child.spawns);
        }
    });
}

/// Likewise for children that the GPU moves; record_gpu_particles adds them to its step.
void find_gpu_spawns(const EmitterSteps& steps, GpuChildren& children, const StepContext& context) {
    constexpr std::uint32_t kSpawns = name_hash("particle sources");
    children.each([&](Entity entity, const ParticleEmitter& emitter, const ParticleSource& source,
                      GpuParticles& particles) {
        particles.spawns.clear();
        const auto parent =
            std::find_if(steps.others.begin(), steps.others.end(), [&](const EmitterStep& other) {
                return other.row.entity == source.emitter;
            });
        if (parent == steps.others.end() || !emitter.active) {
            return;
        }
        const std::uint64_t window = particles.clock.born - particles.oldest();
        const std::size_t room = birth_room(emitter, window, particles.clock);
        Random random(context.seed, subject_of(emitter, entity), kSpawns, context.time.frame);
        std::vector<ParticleSpawn> spawns;
        particles.clock.dropped += find_spawns(
            source, emitter, *parent->row.pool, parent->hits, context.dt, room, random, spawns);
        for (const ParticleSpawn& spawn : spawns) {
            particles.spawns.push_back(place_spawn(spawn));
        }
    });
}

/// Particles before the first block with a dead one stay where they are.
void remove_all_dead(std::span<const EmitterStep> emitters, std::span<const MovedBlock> blocks) {
    std::vector<const MovedBlock*> firsts;
    for (const MovedBlock& block : blocks) {
        if (block.dead > 0 && (firsts.empty() || firsts.back()->emitter != block.emitter)) {
            firsts.push_back(&block);
        }
    }
    parallel_for(firsts.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            remove_dead(emitters[firsts[i]->emitter].row, firsts[i]->first);
        }
    });
}

void add_all_spawns(const EmitterSteps& steps, const StepContext& context) {
    parallel_for(steps.children.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const EmitterStep& child = steps.others[steps.children[i]];
            ParticlePool& pool = *child.row.pool;
            add_spawns(
                *child.row.emitter, child.pose.now, child.spawns, context.seed, child.row.subject(),
                pool);
            pool.fresh = child.spawns.size();
        }
    });
}

}  // namespace

void add_particle_pools(
    Query<const ParticleEmitter, Without<ParticlePool>> emitters,
    Query<const ParticleEmitter, const ParticlePool> pools, Commands commands) {
    emitters.each([&](Entity entity, const ParticleEmitter& emitter) {
        if (!runs_on_gpu(emitter)) {
            commands.add(entity, ParticlePool{});
        }
    });
    pools.each([&](Entity entity, const ParticleEmitter& emitter, const ParticlePool&) {
        if (runs_on_gpu(emitter)) {
            commands.remove<ParticlePool>(entity);
        }
    });
}

void update_particles(
    EmitterQuery emitters, ParticleFollowers followers, BirthSurfaces birth_surfaces,
    ContactSurfaces contact_surfaces, ParticleEnvironment environment) {
    const StepContext context = find_step_context(environment);
    const std::vector<ParticleWater> waters =
        find_particle_waters(contact_surfaces.waters, contact_surfaces.colliders);
    const ParticleSurroundings surroundings = {&contact_surfaces.obstacles->solid, waters};
    const bool may_hit = !surroundings.is_empty();
    EmitterSteps steps = find_emitter_steps(emitters, followers, birth_surfaces, may_hit, context);

    step_independent_emitters(steps.independent, context);

    emit_all(steps.others, context);
    resize_stuck(steps.others);
    std::vector<MovedBlock> blocks = split_into_blocks(steps.others);
    move_all(steps.others, surroundings, blocks);
    collect_hits(blocks, surroundings, contact_surfaces.ripples, steps.others);
    find_spawns(steps, context);
    find_gpu_spawns(steps, followers.gpu_children, context);
    remove_all_dead(steps.others, blocks);
    add_all_spawns(steps, context);
}

}  // namespace limn
