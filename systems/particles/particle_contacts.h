#pragma once

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/water_ripples.h"
#include "ecs/param_group.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/particle_collision.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/water_surface_hits.h"
#include "systems/water/water_query.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// What particles hit during a step, solid or water, and how they respond.

/// Maximum number of particles that move as one piece of work.
inline constexpr std::uint32_t kParticleBlock = 1024;

/// What particles hit, as one parameter of a system.
struct ContactSurfaces {
    Res<const ParticleObstacles> obstacles;
    WaterQuery waters;
    Query<const ParticleCollider> colliders;
    Query<RippleState> ripples;
};
template <>
struct SystemParam<ContactSurfaces> : ParamGroup<
                                          ContactSurfaces, Res<const ParticleObstacles>, WaterQuery,
                                          Query<const ParticleCollider>, Query<RippleState>> {};

/// Everything that particles may hit. The index of a hit is that of a collider, or after those of a
/// body of water.
struct ParticleSurroundings {
    const ColliderSet* solid = nullptr;
    std::span<const ParticleWater> waters;

    [[nodiscard]] bool is_empty() const { return solid->colliders.empty() && waters.empty(); }
};

/// Moves `count` of a pool's particles, from `first` on, and lets them collide. Appends their hits;
/// returns how many have reached the end of life.
[[nodiscard]] std::uint32_t move_colliding_particles(
    const MotionStep& motion, const ParticleCollision& collision,
    const ParticleSurroundings& around, ParticlePool& pool, std::uint32_t first,
    std::uint32_t count, std::vector<ParticleHit>& hits);

/// The bodies of water that have a ParticleCollider of shape Water.
[[nodiscard]] std::vector<ParticleWater>
find_particle_waters(WaterQuery& waters, const Query<const ParticleCollider>& colliders);

/// Ripples on the water where particles have hit it.
void add_ripples(
    std::span<const ParticleHit> hits, const ParticleSurroundings& around,
    Query<RippleState>& ripples);

}  // namespace limn
