#include "systems/particles/particle_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/particles/emitter_place.h"
#include "systems/particles/force_fields.h"
#include "systems/particles/particle_births.h"
#include "systems/particles/particle_contacts.h"
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

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::uint32_t kJobParticles = 4096;  // at least, of one job: small emitters share jobs

/// An emitter in this step.
struct ParticleWork {
    Entity entity;
    const ParticleEmitter* emitter = nullptr;
    const SprayDrops* drops = nullptr;
    const ParticleSource* source = nullptr;
    std::uint32_t parent = kNone;  ///< that source's emitter in the list of works
    const ParticleCollision* collision = nullptr;
    std::vector<ParticleHit> hits = {};
    std::vector<ParticleSpawn> spawns = {};
    ParticlePool* pool = nullptr;
    OrderedBy order = {};
    EmitterPlace place;
    SurfaceSource surface = {};
    float scale = 1;  ///< of its rate
    MotionStep motion = {};
};

/// A part of the particles of an emitter.
struct Block {
    std::uint32_t work = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t dead = 0;
    std::vector<ParticleHit> hits = {};
};

std::uint64_t subject_of(const ParticleWork& work) {
    return subject_of(*work.emitter, work.entity);
}

const SurfaceSource* surface_of(const ParticleWork& work) {
    return work.surface.surface != nullptr ? &work.surface : nullptr;
}

void remove_dead(const OrderedBy& order, ParticlePool& pool, std::size_t first) {
    if (keeps_order(order)) {
        remove_dead_in_order(pool, first);
    } else {
        remove_dead(pool, first);
    }
}

/// The steps before the first one, at the places of that.
void prewarm(const ParticleWork& work, std::uint64_t seed) {
    const ParticleEmitter& emitter = *work.emitter;
    ParticlePool& pool = *work.pool;
    const float dt = work.motion.step.dt;
    std::vector<BirthRun> births;
    for (int i = 0; i < prewarm_steps(emitter, dt); ++i) {
        Random random = prewarm_random(seed, subject_of(work), i);
        const std::size_t room = birth_room(emitter, pool.size(), pool.clock);
        births.clear();
        find_births(emitter, work.scale, dt, room, random, pool.clock, births);
        add_particles(
            emitter, work.place, work.motion.step, surface_of(work), seed, subject_of(work), births,
            pool);
        if (move_block(work.motion, particle_block(pool, 0, pool.size())) > 0) {
            remove_dead(work.order, pool, 0);
        }
    }
}

void emit(const ParticleWork& work, std::uint64_t seed, const FrameTime& time) {
    const ParticleEmitter& emitter = *work.emitter;
    ParticlePool& pool = *work.pool;
    if (work.source != nullptr) {
        return;
    }
    if (is_unused(pool.clock)) {
        prewarm(work, seed);
    }
    const std::uint64_t subject = subject_of(work);
    Random random = births_random(seed, subject, time.frame);
    const std::size_t before = pool.size();
    const std::size_t room = birth_room(emitter, pool.size(), pool.clock);
    thread_local std::vector<BirthRun> births;  // its memory is reused
    births.clear();
    find_births(emitter, work.scale, work.motion.step.dt, room, random, pool.clock, births);
    add_particles(
        emitter, work.place, work.motion.step, surface_of(work), seed, subject, births, pool);
    if (work.drops != nullptr && emitter.active) {
        add_drops(emitter, work.drops->drops, work.motion.step, seed, subject, pool);
    }
    pool.fresh = pool.size() - before;
}

/// An emitter whose particles meet nothing and have to do with no other emitter: few enough to be
/// one piece of work.
struct Alone {
    Entity entity;
    const ParticleEmitter* emitter = nullptr;
    const ParticleMotion* motion = nullptr;  ///< null: none
    const WorldTransform* now = nullptr;
    const PreviousWorldTransform* previous = nullptr;
    const ParticleWrap* wrap = nullptr;
    ParticlePool* pool = nullptr;
    OrderedBy order = {};
};

constexpr std::size_t kAloneJob = 64;  ///< emitters of one job

/// What is the same for all emitters in a step.
struct StepInputs {
    Vec3 wind;
    EmitterEye eye;
    std::span<const Force> forces;
    float dt;
    std::uint64_t seed;
    const FrameTime* time;
};

/// Motions of emitters one after another: many of them move alike.
class Motions {
  public:
    explicit Motions(const StepInputs& inputs) : inputs_(inputs) {}

    /// Valid until the next call.
    const MotionStep& of(const Alone& alone) {
        static const ParticleMotion kStill;
        const ParticleMotion& asked = alone.motion != nullptr ? *alone.motion : kStill;
        // Bytes: padding that differs costs time only.
        if (!known_ || std::memcmp(&asked, &asked_, sizeof(asked)) != 0) {
            step_ = find_motion(
                asked, alone.now->world, inputs_.wind, inputs_.forces, inputs_.dt, *inputs_.time);
            std::memcpy(&asked_, &asked, sizeof(asked));
            known_ = true;
        } else if (is_placed()) {
            turn_motion(step_, alone.now->world);
        }
        const bool wraps = alone.wrap != nullptr && !step_.step.closed_form;
        step_.wrap_size = wraps ? alone.wrap->size : Vec3(0);
        step_.wrap_center = inputs_.eye.place;
        return step_;
    }

  private:
    /// Whether it depends on where the emitter is.
    [[nodiscard]] bool is_placed() const {
        return step_.vortex.around != 0 || step_.vortex.toward != 0 || step_.steering.orbit > 0
               || step_.steering.loss > 0;
    }

    const StepInputs& inputs_;
    bool known_ = false;
    ParticleMotion asked_;
    MotionStep step_;
};
static_assert(std::is_trivially_copyable_v<ParticleMotion>);

/// All of a step.
void step_alone(const Alone& alone, Motions& motions, const StepInputs& inputs) {
    const MotionStep& motion = motions.of(alone);
    ParticlePool& pool = *alone.pool;
    if (!is_unused(pool.clock) && has_no_births(*alone.emitter, inputs.dt, pool.clock)) {
        pool.clock.time += static_cast<double>(inputs.dt);
        pool.fresh = 0;
    } else {
        ParticleWork work{.entity = alone.entity, .place = place_of(*alone.now, *alone.previous)};
        work.emitter = alone.emitter;
        work.motion = motion;
        work.scale = seen_share(*alone.emitter, alone.now->world, inputs.eye);
        work.pool = alone.pool;
        work.order = alone.order;
        emit(work, inputs.seed, *inputs.time);
    }
    pool.stuck.clear();
    if (move_block(motion, particle_block(pool, 0, pool.size())) > 0) {
        remove_dead(alone.order, pool, 0);
    }
}

/// Emitters whose particles give birth, in order.
std::vector<Entity> find_parents(const Query<const ParticleSource>& sources) {
    std::vector<Entity> parents;
    sources.each([&](const ParticleSource& source) { parents.push_back(source.emitter); });
    std::sort(parents.begin(), parents.end());
    return parents;
}

/// Emitters whose particles others take one after another, in order.
std::vector<Entity>
find_followed(const Query<const Trail>& trails, const std::vector<Entity>& parents) {
    std::vector<Entity> followed = parents;
    trails.each([&](Entity entity, const Trail& trail) {
        if (trail.path != TrailPath::Entity) {
            followed.push_back(trail.emitter.is_null() ? entity : trail.emitter);
        }
    });
    std::sort(followed.begin(), followed.end());
    return followed;
}

bool is_among(const std::vector<Entity>& sorted, Entity entity) {
    return !sorted.empty() && std::binary_search(sorted.begin(), sorted.end(), entity);
}

/// Those whose particles are born where others are.
std::vector<ParticleWork*> find_children(std::vector<ParticleWork>& works) {
    std::vector<ParticleWork*> children;
    for (ParticleWork& work : works) {
        if (work.source != nullptr) {
            children.push_back(&work);
        }
    }
    for (ParticleWork* child : children) {
        ParticleWork& work = *child;
        if (work.source->emitter == work.entity) {
            continue;
        }
        const auto parent =
            std::find_if(works.begin(), works.end(), [&](const ParticleWork& other) {
                return other.entity == work.source->emitter;
            });
        work.parent =
            parent != works.end() ? static_cast<std::uint32_t>(parent - works.begin()) : kNone;
    }
    return children;
}

/// Ends of runs of blocks that have enough to do for a job; the same for any number of threads.
std::vector<std::size_t> split_into_jobs(const std::vector<Block>& blocks) {
    std::vector<std::size_t> ends;
    std::uint32_t particles = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        particles += blocks[i].count;
        if (particles >= kJobParticles || i + 1 == blocks.size()) {
            ends.push_back(i + 1);
            particles = 0;
        }
    }
    return ends;
}

/// Births by the particles of the work's parent, which have moved and not lost their dead yet.
void find_spawns_of(
    ParticleWork& work, const std::vector<ParticleWork>& works, std::uint64_t seed,
    const FrameTime& time) {
    if (work.parent == kNone || !work.emitter->active) {
        return;
    }
    const std::size_t room = birth_room(*work.emitter, work.pool->size(), work.pool->clock);
    Random random(seed, subject_of(work), name_hash("particle sources"), time.frame);
    work.pool->clock.dropped += find_spawns(
        *work.source, *work.emitter, *works[work.parent].pool, works[work.parent].hits,
        work.motion.step.dt, room, random, work.spawns);
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
    Query<
        const ParticleEmitter, Optional<const ParticleMotion>, const WorldTransform,
        const PreviousWorldTransform, Optional<const SprayDrops>, Optional<const ParticleSource>,
        Optional<const ParticleSurface>, Optional<const ParticleMesh>,
        Optional<const ParticleCollision>, Optional<const ParticleWrap>,
        Optional<const ParticleLook>, Optional<const ParticleLight>, ParticlePool>
        emitters,
    Query<const ParticleSource> sources, Query<const Trail> trails, MeshQuery meshes,
    Query<const Pose> poses, Query<const MorphWeights> morphs, Res<const Assets> assets,
    Res<const ParticleObstacles> obstacles, WaterQuery waters,
    Query<const ParticleCollider> colliders, Query<RippleState> ripples,
    Query<const ForceField, const WorldTransform> fields,
    Query<const Camera, const WorldTransform> cameras, Res<const WeatherState> gusts,
    OptionalRes<const Weather> weather, Res<const RandomSeed> seed, Res<const FrameTime> time) {
    const float dt = std::min(time->step, kMaxParticleStep);
    const Vec3 wind = weather ? current_weather(*weather, *gusts).wind() : Vec3(0);
    const EmitterEye eye = find_eye(cameras);
    const std::vector<Force> forces = find_forces(fields, time->time);
    const StepInputs inputs = {wind, eye, forces, dt, seed->seed, &*time};
    const std::vector<ParticleWater> wet = find_particle_waters(waters, colliders);
    const ParticleSurroundings around = {&obstacles->solid, wet};
    const std::vector<Entity> parents = find_parents(sources);
    const std::vector<Entity> followed = find_followed(trails, parents);
    std::vector<Alone> alone;
    alone.reserve(emitters.count());
    std::vector<ParticleWork> works;
    emitters.each([&](Entity entity, const ParticleEmitter& emitter, const ParticleMotion* motion,
                      const WorldTransform& now, const PreviousWorldTransform& previous,
                      const SprayDrops* drops, const ParticleSource* source,
                      const ParticleSurface* surface, const ParticleMesh* mesh,
                      const ParticleCollision* collision, const ParticleWrap* wrap,
                      const ParticleLook* look, const ParticleLight* light, ParticlePool& pool) {
        const OrderedBy order = {
            look, light, emitter.population == ParticlePopulation::Linear, mesh != nullptr,
            is_among(followed, entity)};
        if (pool.mixed && keeps_order(order)) {
            restore_order(pool);
        }
        const bool meets_nothing =
            collision == nullptr || wrap != nullptr
            || (around.is_empty() && collision->action != CollisionAction::Stick);
        if (pool.size() <= kParticleBlock && meets_nothing && drops == nullptr && source == nullptr
            && surface == nullptr && !is_among(parents, entity)) {
            alone.push_back({entity, &emitter, motion, &now, &previous, wrap, &pool, order});
            return;
        }
        const EmitterPlace place = place_of(now, previous);
        static const ParticleMotion kStill;
        ParticleWork work{.entity = entity, .place = place};
        work.motion =
            find_motion(motion != nullptr ? *motion : kStill, now.world, wind, forces, dt, *time);
        work.scale = seen_share(emitter, now.world, eye);
        work.emitter = &emitter;
        work.drops = drops;
        work.source = source;
        if (surface != nullptr) {
            work.surface =
                find_surface_source(*surface, mesh, entity, place, meshes, poses, morphs, *assets);
        }
        work.collision = wrap == nullptr ? collision : nullptr;
        if (wrap != nullptr && !work.motion.step.closed_form) {
            work.motion.wrap_size = wrap->size;
            work.motion.wrap_center = eye.place;
        }
        work.pool = &pool;
        work.order = order;
        works.push_back(std::move(work));
    });

    parallel_for(alone.size(), kAloneJob, [&](std::size_t begin, std::size_t end) {
        Motions motions(inputs);
        for (std::size_t i = begin; i < end; ++i) {
            step_alone(alone[i], motions, inputs);
        }
    });
    parallel_for(works.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            emit(works[i], seed->seed, *time);
        }
    });

    std::vector<Block> blocks;
    for (std::uint32_t w = 0; w < works.size(); ++w) {
        const bool sticks =
            works[w].collision != nullptr && works[w].collision->action == CollisionAction::Stick;
        works[w].pool->stuck.resize(sticks ? works[w].pool->size() : 0);
        const auto size = static_cast<std::uint32_t>(works[w].pool->size());
        for (std::uint32_t first = 0; first < size; first += kParticleBlock) {
            Block block;
            block.work = w;
            block.first = first;
            block.count = std::min<std::uint32_t>(size - first, kParticleBlock);
            blocks.push_back(std::move(block));
        }
    }
    const std::vector<std::size_t> ends = split_into_jobs(blocks);
    parallel_for(ends.size(), 1, [&](std::size_t job, std::size_t) {
        for (std::size_t i = job == 0 ? 0 : ends[job - 1]; i < ends[job]; ++i) {
            Block& block = blocks[i];
            const ParticleWork& work = works[block.work];
            if (work.collision != nullptr && !around.is_empty()) {
                block.dead = move_colliding_particles(
                    work.motion, *work.collision, around, *work.pool, block.first, block.count,
                    block.hits);
            } else {
                block.dead = static_cast<std::uint32_t>(
                    move_block(work.motion, particle_block(*work.pool, block.first, block.count)));
            }
        }
    });
    for (const Block& block : blocks) {
        std::vector<ParticleHit>& hits = works[block.work].hits;
        hits.insert(hits.end(), block.hits.begin(), block.hits.end());
        add_dents(block.hits, around, ripples);
    }

    // Children's births wait until the dead are gone: their parents may be children too.
    const std::vector<ParticleWork*> children = find_children(works);
    parallel_for(children.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            find_spawns_of(*children[i], works, seed->seed, *time);
        }
    });

    // Those before the first block with a dead one stay where they are.
    std::vector<Block> firsts;
    for (const Block& block : blocks) {
        if (block.dead > 0 && (firsts.empty() || firsts.back().work != block.work)) {
            firsts.push_back(block);
        }
    }
    parallel_for(firsts.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const ParticleWork& work = works[firsts[i].work];
            remove_dead(work.order, *work.pool, firsts[i].first);
        }
    });
    parallel_for(children.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const ParticleWork& work = *children[i];
            add_spawns(
                *work.emitter, work.place.now, work.spawns, seed->seed, subject_of(work),
                *work.pool);
            work.pool->fresh = work.spawns.size();
        }
    });
}

}  // namespace limn
