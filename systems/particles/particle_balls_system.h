#pragma once

#include "ecs/components/particle_balls.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/particle_obstacles.h"

#include <cstdint>
#include <vector>

namespace limn {

// Particles that collide with each other (particle.interparticle; after Kipfer, Segal and
// Westermann, "UberFlow", 2004): they are sorted by the cells of a grid whose cells are as wide as
// a ball, so that all that touch a ball are in the 27 cells around it. In several passes, each pair
// is moved apart by half of its overlap each, and colliders are resolved after each pass; then
// pairs separate at a fraction of their approach speed (Mueller et al., "Detailed Rigid Body
// Simulation with Extended Position Based Dynamics", 2020). So heaps come to rest, and overlaps do
// not explode. Momentum is conserved; in a collision of two with a bounce of 1, energy too.

/// Two particles of a pool, by index.
struct BallPair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

/// Pairs closer than 2 `radius` [m], each once. Each particle is tested against at most 64 of those
/// after it in the order of cells. The order of pairs depends on the positions alone.
void find_ball_pairs(const ParticlePool& pool, float radius, std::vector<BallPair>& pairs);

/// The solid colliders that balls may not be pushed into: all but water.
struct BallWalls {
    const ColliderSet* solid = nullptr;
    float radius = 0;  ///< of a ball against walls: ParticleCollision::radius [m]
};

/// Resolves the collisions of particles of a pool that touch at the end of a step of `dt` [s].
/// Particles that stick to a surface do not move.
void collide_balls(
    const ParticleBalls& balls, const BallWalls& walls, float dt, ParticlePool& pool);

/// For all emitters; after update_particles.
void update_particle_balls(
    Query<const ParticleBalls, Optional<const ParticleCollision>, ParticlePool> emitters,
    Res<const ParticleObstacles> obstacles, Res<const FrameTime> time);

}  // namespace limn
