#include "systems/particles/particle_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/particles/emitter_place.h"
#include "systems/particles/particle_births.h"
#include "systems/particles/particle_collision.h"
#include "systems/particles/particle_kernels.h"
#include "systems/particles/particle_motion.h"
#include "systems/particles/particle_sources.h"
#include "systems/particles/water_surface_hits.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::uint32_t kBlock = 1024;  // particles that move as one piece of work
constexpr std::size_t kBlockGrain = 4;  // blocks of one job
constexpr float kDry = 1e-3f;           // kept above water by what bounces off or sticks [m]

/// An emitter in this step.
struct Work {
    Entity entity;
    const ParticleEmitter* emitter = nullptr;
    const SprayDrops* drops = nullptr;
    const ParticleSource* source = nullptr;
    std::uint32_t parent = kNone;  ///< that source's emitter in the list of works
    const ParticleCollision* collision = nullptr;
    std::vector<ParticleHit> hits = {};
    std::vector<ParticleSpawn> spawns = {};
    ParticlePool* pool = nullptr;
    EmitterPlace place;
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

std::uint64_t subject_of(const Work& work) {
    return subject_of(*work.emitter, work.entity);
}

/// The steps before the first one, at the places of that.
void prewarm(const Work& work, std::uint64_t seed) {
    const ParticleEmitter& emitter = *work.emitter;
    ParticlePool& pool = *work.pool;
    const float dt = work.motion.step.dt;
    std::vector<BirthRun> births;
    for (int i = 0; i < prewarm_steps(emitter, dt); ++i) {
        Random random = prewarm_random(seed, subject_of(work), i);
        const std::size_t room =
            emitter.capacity > pool.size() ? emitter.capacity - pool.size() : 0;
        births.clear();
        find_births(emitter, work.scale, dt, room, random, pool.clock, births);
        add_particles(emitter, work.place, work.motion.step, seed, subject_of(work), births, pool);
        if (move_block(work.motion, particle_block(pool, 0, pool.size())) > 0) {
            remove_dead(pool, 0);
        }
    }
}

void emit(const Work& work, std::uint64_t seed, const FrameTime& time) {
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
    const std::size_t room = emitter.capacity > pool.size() ? emitter.capacity - pool.size() : 0;
    std::vector<BirthRun> births;
    find_births(emitter, work.scale, work.motion.step.dt, room, random, pool.clock, births);
    add_particles(emitter, work.place, work.motion.step, seed, subject, births, pool);
    if (work.drops != nullptr && emitter.active) {
        add_drops(emitter, work.drops->drops, work.motion.step, seed, subject, pool);
    }
    pool.fresh = pool.size() - before;
}

void find_parents(std::vector<Work>& works) {
    for (Work& work : works) {
        if (work.source == nullptr || work.source->emitter == work.entity) {
            continue;
        }
        const auto parent = std::find_if(works.begin(), works.end(), [&](const Work& other) {
            return other.entity == work.source->emitter;
        });
        work.parent =
            parent != works.end() ? static_cast<std::uint32_t>(parent - works.begin()) : kNone;
    }
}

/// Births by the particles of the work's parent, which have moved and not lost their dead yet.
void find_spawns_of(
    Work& work, const std::vector<Work>& works, std::uint64_t seed, const FrameTime& time) {
    if (work.parent == kNone || !work.emitter->active) {
        return;
    }
    const std::size_t size = work.pool->size();
    const std::size_t room = work.emitter->capacity > size ? work.emitter->capacity - size : 0;
    Random random(seed, subject_of(work), name_hash("particle sources"), time.frame);
    work.pool->clock.dropped += find_spawns(
        *work.source, *work.emitter, *works[work.parent].pool, works[work.parent].hits,
        work.motion.step.dt, room, random, work.spawns);
}

std::uint32_t move_alone(const Work& work, const Block& block) {
    return static_cast<std::uint32_t>(
        move_block(work.motion, particle_block(*work.pool, block.first, block.count)));
}

/// Everything that colliding particles may meet.
struct Around {
    const ColliderSet* solid = nullptr;
    std::span<const ParticleWater> waters;
    [[nodiscard]] bool is_empty() const { return solid->colliders.empty() && waters.empty(); }
};

/// A particle of a block that would enter water, if nothing solid is before it.
struct Entry {
    std::uint32_t particle = 0;  ///< within the block
    WaterContact contact;
};

/// A block of a pool in this step: where its particles began, and where they are.
struct Paths {
    std::array<float, kBlock> start[3];
    std::array<std::uint8_t, kBlock> marks{};
    CollidingParticles particles;

    [[nodiscard]] Vec3 from(std::size_t i) const { return {start[0][i], start[1][i], start[2][i]}; }
    [[nodiscard]] Vec3 to(std::size_t i) const {
        return {particles.x[i], particles.y[i], particles.z[i]};
    }
    [[nodiscard]] Vec3 velocity(std::size_t i) const {
        return {particles.vx[i], particles.vy[i], particles.vz[i]};
    }
    void move(std::size_t i, const Vec3& to, const Vec3& velocity) const {
        particles.x[i] = to.x;
        particles.y[i] = to.y;
        particles.z[i] = to.z;
        particles.vx[i] = velocity.x;
        particles.vy[i] = velocity.y;
        particles.vz[i] = velocity.z;
    }
};

void begin_paths(const Work& work, const Block& block, Paths& paths) {
    ParticlePool& pool = *work.pool;
    const auto part = [&](std::vector<float>& column) {
        return std::span(column).subspan(block.first, block.count);
    };
    const auto began = [&](int axis) {
        return std::span<const float>(paths.start[axis]).first(block.count);
    };
    paths.particles = {
        .x0 = began(0),
        .y0 = began(1),
        .z0 = began(2),
        .x = part(pool.x),
        .y = part(pool.y),
        .z = part(pool.z),
        .vx = part(pool.vx),
        .vy = part(pool.vy),
        .vz = part(pool.vz),
        .marks = std::span(paths.marks).first(block.count),
        .first = block.first};
    int axis = 0;
    for (const std::span<float> place : {paths.particles.x, paths.particles.y, paths.particles.z}) {
        std::copy(place.begin(), place.end(), paths.start[axis++].begin());
    }
    for (std::size_t i = 0; i < block.count && block.first + i < pool.stuck.size(); ++i) {
        paths.marks[i] = pool.stuck[block.first + i] != 0 ? kParticleStuck : 0;
    }
}

/// Ends the ways of those that would enter water at its surface.
void stop_at_water(
    const Paths& paths, std::span<const ParticleWater> waters, std::vector<Entry>& entries) {
    for (std::uint32_t i = 0; i < paths.particles.x.size(); ++i) {
        if (paths.marks[i] != 0) {
            continue;
        }
        if (const auto contact = enter_water(waters, paths.from(i), paths.to(i))) {
            entries.push_back({i, *contact});
            paths.move(i, contact->point, paths.velocity(i));
        }
    }
}

/// What the water does to those that met nothing solid before.
void hit_water(
    Paths& paths, const Work& work, const Around& around, std::span<const Entry> entries,
    Block& block) {
    const ParticleCollision& collision = *work.collision;
    for (const auto& [i, contact] : entries) {
        if (paths.marks[i] != 0) {
            continue;
        }
        const Vec3 velocity = paths.velocity(i);
        const auto collider =
            static_cast<std::uint32_t>(around.solid->colliders.size()) + contact.water;
        block.hits.push_back({block.first + i, collider, contact.point, contact.normal, velocity});
        Vec3 after(0);
        if (collision.action == CollisionAction::Bounce) {
            after = respond(velocity, contact.normal, {collision.bounce, collision.friction});
        }
        const float rest = (1 - contact.share) * work.motion.step.dt;
        paths.move(i, contact.point + kDry * contact.normal + rest * after, after);
        paths.marks[i] = collision.action == CollisionAction::Kill    ? kParticleKilled
                         : collision.action == CollisionAction::Stick ? kParticleStuck
                                                                      : kParticleHit;
    }
}

/// Moves a block whose particles collide.
void move_colliding(const Work& work, const Around& around, Block& block) {
    ParticlePool& pool = *work.pool;
    Paths paths;
    begin_paths(work, block, paths);
    block.dead = move_alone(work, block);
    const ParticleCollision& collision = *work.collision;
    CollisionOptions options;
    options.radius = finite_or(collision.radius, 0);
    options.action = collision.action == CollisionAction::Kill    ? ContactAction::Kill
                     : collision.action == CollisionAction::Stick ? ContactAction::Stick
                                                                  : ContactAction::Bounce;
    std::vector<Entry> entries;
    stop_at_water(paths, around.waters, entries);
    collide_particles(
        paths.particles, work.motion.step.dt, *around.solid, {collision.bounce, collision.friction},
        options, block.hits);
    hit_water(paths, work, around, entries, block);
    for (std::uint32_t i = 0; i < block.count; ++i) {
        const std::uint32_t at = block.first + i;
        if (at < pool.stuck.size()) {
            pool.stuck[at] = (paths.marks[i] & kParticleStuck) != 0 ? 1 : 0;
        }
        if ((paths.marks[i] & kParticleKilled) != 0 && pool.age[at] < pool.life[at]) {
            pool.life[at] = pool.age[at];
            ++block.dead;
        }
    }
}

std::vector<ParticleWater>
find_waters(WaterQuery& waters, const Query<const ParticleCollider>& colliders) {
    std::vector<ParticleWater> found;
    for (const WaterSurface& surface : collect_water_surfaces(waters)) {
        const auto* collider = colliders.find<const ParticleCollider>(surface.entity);
        if (collider != nullptr && collider->shape == ColliderShape::Water) {
            found.push_back(
                {surface, surface.frame.origin.y + highest_wave(surface), collider->ripple,
                 collider->ripple_radius});
        }
    }
    return found;
}

/// Dents in the water where the particles of a block have hit it.
void add_dents(const Block& block, const Around& around, Query<RippleState>& ripples) {
    const std::size_t solids = around.solid->colliders.size();
    for (const ParticleHit& hit : block.hits) {
        if (hit.collider < solids) {
            continue;
        }
        const ParticleWater& water = around.waters[hit.collider - solids];
        RippleState* const state = ripples.find<RippleState>(water.surface.entity);
        if (state != nullptr && water.ripple > 0) {
            state->impulses.push_back(make_dent(water, hit.point, hit.velocity));
        }
    }
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
        Optional<const ParticleCollision>, Optional<const ParticleWrap>, ParticlePool>
        emitters,
    Res<const ParticleObstacles> obstacles, WaterQuery waters,
    Query<const ParticleCollider> colliders, Query<RippleState> ripples,
    Query<const Camera, const WorldTransform> cameras, Res<const WeatherState> gusts,
    OptionalRes<const Weather> weather, Res<const RandomSeed> seed, Res<const FrameTime> time) {
    const float dt = std::min(time->step, kMaxParticleStep);
    const Vec3 wind = weather ? current_weather(*weather, *gusts).wind() : Vec3(0);
    const EmitterEye eye = find_eye(cameras);
    std::vector<Work> works;
    emitters.each([&](Entity entity, const ParticleEmitter& emitter, const ParticleMotion* motion,
                      const WorldTransform& now, const PreviousWorldTransform& previous,
                      const SprayDrops* drops, const ParticleSource* source,
                      const ParticleCollision* collision, const ParticleWrap* wrap,
                      ParticlePool& pool) {
        const EmitterPlace place = place_of(now, previous);
        static const ParticleMotion kStill;
        Work work{.entity = entity, .place = place};
        work.motion = find_motion(motion != nullptr ? *motion : kStill, now.world, wind, dt, *time);
        work.scale = seen_share(emitter, now.world, eye);
        work.emitter = &emitter;
        work.drops = drops;
        work.source = source;
        work.collision = wrap == nullptr ? collision : nullptr;
        if (wrap != nullptr) {
            work.motion.wrap_size = wrap->size;
            work.motion.wrap_center = eye.place;
        }
        work.pool = &pool;
        works.push_back(work);
    });

    parallel_for(works.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            emit(works[i], seed->seed, *time);
        }
    });

    const std::vector<ParticleWater> wet = find_waters(waters, colliders);
    const Around around = {&obstacles->solid, wet};
    std::vector<Block> blocks;
    for (std::uint32_t w = 0; w < works.size(); ++w) {
        const bool sticks =
            works[w].collision != nullptr && works[w].collision->action == CollisionAction::Stick;
        works[w].pool->stuck.resize(sticks ? works[w].pool->size() : 0);
        const auto size = static_cast<std::uint32_t>(works[w].pool->size());
        for (std::uint32_t first = 0; first < size; first += kBlock) {
            Block block;
            block.work = w;
            block.first = first;
            block.count = std::min<std::uint32_t>(size - first, kBlock);
            blocks.push_back(std::move(block));
        }
    }
    parallel_for(blocks.size(), kBlockGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Block& block = blocks[i];
            const Work& work = works[block.work];
            if (work.collision != nullptr && !around.is_empty()) {
                move_colliding(work, around, block);
            } else {
                block.dead = move_alone(work, block);
            }
        }
    });
    for (const Block& block : blocks) {
        std::vector<ParticleHit>& hits = works[block.work].hits;
        hits.insert(hits.end(), block.hits.begin(), block.hits.end());
        add_dents(block, around, ripples);
    }

    // Children's births wait until the dead are gone: their parents may be children too.
    find_parents(works);
    parallel_for(works.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            find_spawns_of(works[i], works, seed->seed, *time);
        }
    });

    // Those before the first block with a dead one stay where they are.
    std::vector<Block> firsts;
    for (const Block& block : blocks) {
        if (block.dead > 0 && (firsts.empty() || firsts.back().work != block.work)) {
            firsts.push_back(block);
        }
    }
    parallel_for(firsts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            remove_dead(*works[firsts[i].work].pool, firsts[i].first);
        }
    });
    parallel_for(works.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Work& work = works[i];
            if (work.source != nullptr) {
                add_spawns(
                    *work.emitter, work.place.now, work.spawns, seed->seed, subject_of(work),
                    *work.pool);
                work.pool->fresh = work.spawns.size();
            }
        }
    });
}

}  // namespace limn
