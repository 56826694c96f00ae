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
// Westermann, "UberFlow", 2004): they are sorted by the cells of a grid as wide as a ball, so that
// whoever touches a ball is in one of the 27 cells around it. Pairs are moved apart by half of
// their overlap each, pair by pair, a few times, with walls in between; then they part by their
// fraction of the speed at which they met (Mueller et al., "Detailed Rigid Body Simulation with
// Extended Position Based Dynamics", 2020). So heaps rest, and overlaps do not explode. Momentum is
// kept; of two that meet, with a bounce of 1, energy too.

/// Two particles of a pool, by index.
struct BallPair {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

/// Pairs nearer than 2 `radius` [m], each once, at most 64 for each particle as its first. In an
/// order that depends on the positions alone.
void find_ball_pairs(const ParticlePool& pool, float radius, std::vector<BallPair>& pairs);

/// What holds the balls of an emitter. Of its meshes, planes and so on, not of water.
struct BallWalls {
    const ColliderSet* solid = nullptr;
    float radius = 0;  ///< of a ball before a wall: ParticleCollision::radius [m]
};

/// Lets those of a pool collide that touch now, at the end of a step of `dt` [s]. Particles that
/// stick to a surface do not move.
void collide_balls(
    const ParticleBalls& balls, const BallWalls& walls, float dt, ParticlePool& pool);

/// For all emitters; after update_particles.
void update_particle_balls(
    Query<const ParticleBalls, Optional<const ParticleCollision>, ParticlePool> emitters,
    Res<const ParticleObstacles> obstacles, Res<const FrameTime> time);

}  // namespace limn
