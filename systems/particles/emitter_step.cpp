#include "systems/particles/emitter_step.h"

#include "systems/particles/particle_births.h"
#include "systems/particles/particle_contacts.h"
#include "systems/particles/particle_kernels.h"
#include "systems/particles/particle_motion.h"

#include <algorithm>
#include <utility>

namespace limn {
namespace {

/// Entities in ascending order.
class EntitySet {
  public:
    void add(Entity entity) { entities_.push_back(entity); }
    void add(const EntitySet& more) {
        entities_.insert(entities_.end(), more.entities_.begin(), more.entities_.end());
    }
    void sort() { std::sort(entities_.begin(), entities_.end()); }
    [[nodiscard]] bool contains(Entity entity) const {
        return !entities_.empty() && std::binary_search(entities_.begin(), entities_.end(), entity);
    }

  private:
    std::vector<Entity> entities_;
};

/// Emitters whose particles give birth to those of others.
EntitySet find_parents(const ParticleFollowers& followers) {
    EntitySet parents;
    followers.sources.each([&](const ParticleSource& source) { parents.add(source.emitter); });
    parents.sort();
    return parents;
}

/// Emitters whose particles are identified by their order: parents, and those with trails.
EntitySet find_followed(const ParticleFollowers& followers, const EntitySet& parents) {
    EntitySet followed = parents;
    followers.trails.each([&](Entity entity, const Trail& trail) {
        if (trail.path != TrailPath::Entity) {
            followed.add(trail.emitter.is_null() ? entity : trail.emitter);
        }
    });
    followed.sort();
    return followed;
}

bool is_independent(const EmitterRow& row, const EntitySet& parents, bool may_hit) {
    const bool hits_nothing =
        row.collision == nullptr || (!may_hit && row.collision->action != CollisionAction::Stick);
    return row.pool->size() <= kParticleBlock && hits_nothing && row.drops == nullptr
           && row.source == nullptr && row.surface == nullptr && !parents.contains(row.entity);
}

/// For followers that depend on the order only since this step.
void restore_order_if_needed(const EmitterRow& row) {
    if (row.pool->mixed && keeps_order(row.order)) {
        restore_order(*row.pool);
    }
}

/// Lists the children and finds their parents; none is its own parent.
void link_children(EmitterSteps& steps) {
    for (std::uint32_t i = 0; i < steps.others.size(); ++i) {
        EmitterStep& child = steps.others[i];
        if (child.row.source == nullptr) {
            continue;
        }
        steps.children.push_back(i);
        const Entity wanted = child.row.source->emitter;
        const auto parent =
            std::find_if(steps.others.begin(), steps.others.end(), [&](const EmitterStep& other) {
                return other.row.entity == wanted;
            });
        if (wanted != child.row.entity && parent != steps.others.end()) {
            child.parent = static_cast<std::uint32_t>(parent - steps.others.begin());
        }
    }
}

const SurfaceSource* surface_of(const EmitterStep& step) {
    return step.surface.surface != nullptr ? &step.surface : nullptr;
}

/// The births of one step by the clock of the emitter.
void add_births(const EmitterStep& step, float dt, Random random, const StepContext& context) {
    const ParticleEmitter& emitter = *step.row.emitter;
    ParticlePool& pool = *step.row.pool;
    thread_local std::vector<BirthRun> births;  // its memory is reused
    births.clear();
    const std::size_t room = birth_room(emitter, pool.size(), pool.clock);
    find_births(emitter, step.rate_scale, dt, room, random, pool.clock, births);
    add_particles(
        emitter, step.pose, step.motion.step, surface_of(step), context.seed, step.row.subject(),
        births, pool);
}

/// Simulates the time before the first step, as if the emitter had always been where it is.
void prewarm(const EmitterStep& step, const StepContext& context) {
    ParticlePool& pool = *step.row.pool;
    for (int i = 0; i < prewarm_steps(*step.row.emitter, context.dt); ++i) {
        add_births(step, context.dt, prewarm_random(context.seed, step.row.subject(), i), context);
        if (move_block(step.motion, particle_block(pool, 0, pool.size())) > 0) {
            remove_dead(step.row, 0);
        }
    }
}

}  // namespace

EmitterStep
make_emitter_step(const EmitterRow& row, const MotionStep& motion, const StepContext& context) {
    EmitterStep step;
    step.row = row;
    step.pose = emitter_pose(*row.now, *row.previous);
    step.motion = motion;
    step.rate_scale = screen_coverage(*row.emitter, row.now->world, context.eye);
    return step;
}

EmitterSteps find_emitter_steps(
    EmitterQuery& emitters, const ParticleFollowers& followers, const BirthSurfaces& surfaces,
    bool may_hit, const StepContext& context) {
    const EntitySet parents = find_parents(followers);
    const EntitySet followed = find_followed(followers, parents);
    EmitterSteps steps;
    steps.independent.reserve(emitters.count());
    emitters.each([&](Entity entity, const ParticleEmitter& emitter, const ParticleMotion* motion,
                      const WorldTransform& now, const PreviousWorldTransform& previous,
                      const SprayDrops* drops, const ParticleSource* source,
                      const ParticleSurface* surface, const ParticleMesh* mesh,
                      const ParticleCollision* collision, const ParticleWrap* wrap,
                      const ParticleLook* look, const ParticleLight* light, ParticlePool& pool) {
        const EmitterRow row = {
            .entity = entity,
            .emitter = &emitter,
            .motion = motion,
            .now = &now,
            .previous = &previous,
            .drops = drops,
            .source = source,
            .surface = surface,
            .mesh = mesh,
            .collision = wrap == nullptr ? collision : nullptr,
            .wrap = wrap,
            .pool = &pool,
            .order = {
                .look = look,
                .light = light,
                .window = emitter.population == ParticlePopulation::Linear,
                .meshes = mesh != nullptr,
                .followed = followed.contains(entity)}};
        restore_order_if_needed(row);
        if (is_independent(row, parents, may_hit)) {
            steps.independent.push_back(row);
            return;
        }
        EmitterStep step =
            make_emitter_step(row, find_emitter_motion(motion, wrap, now.world, context), context);
        if (surface != nullptr) {
            step.surface = find_surface_source(
                *surface, mesh, entity, step.pose, surfaces.meshes, surfaces.poses, surfaces.morphs,
                *surfaces.assets);
        }
        steps.others.push_back(std::move(step));
    });
    link_children(steps);
    return steps;
}

void emit_particles(EmitterStep& step, const StepContext& context) {
    if (step.row.source != nullptr) {
        return;
    }
    const ParticleEmitter& emitter = *step.row.emitter;
    ParticlePool& pool = *step.row.pool;
    if (is_unused(pool.clock)) {
        prewarm(step, context);
    }
    const std::uint64_t subject = step.row.subject();
    const std::size_t before = pool.size();
    add_births(step, context.dt, births_random(context.seed, subject, context.time.frame), context);
    if (step.row.drops != nullptr && emitter.active) {
        add_drops(emitter, step.row.drops->drops, step.motion.step, context.seed, subject, pool);
    }
    pool.fresh = pool.size() - before;
}

void remove_dead(const EmitterRow& row, std::size_t first) {
    if (keeps_order(row.order)) {
        remove_dead_in_order(*row.pool, first);
    } else {
        remove_dead(*row.pool, first);
    }
}

}  // namespace limn
