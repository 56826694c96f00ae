#pragma once

#include "ecs/commands.h"
#include "ecs/components/beam.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/particle_obstacles.h"

namespace limn {

/// Adds a BeamState to every Beam that lacks one. Before update_beams, with a sync point in
/// between.
void add_beam_states(Query<const Beam, Without<BeamState>> beams, Commands commands);

/// Finds the ends of all beams. After update_transforms and find_particle_obstacles.
void update_beams(
    Query<const Beam, const WorldTransform, BeamState> beams,
    Query<const WorldTransform> transforms, Res<const ParticleObstacles> obstacles);

}  // namespace limn
