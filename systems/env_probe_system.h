#pragma once

#include "ecs/commands.h"
#include "ecs/components/env_probe.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"

namespace limn {

// Schedules captures of environment probes (env.update-policy); the renderer draws the cube map
// faces that are due. A frame is a step of the world. Changes around a probe at rest are captured
// only by its period.

/// Gives each EnvProbe its state.
void add_env_probe_states(Query<const EnvProbe, Without<EnvProbeState>> probes, Commands commands);

/// Runs after update_transforms: captures use the entity's current position.
void update_env_probes(Query<const EnvProbe, const WorldTransform, EnvProbeState> probes);

/// One frame of one probe at `position`.
void step_env_probe(const EnvProbe& probe, const Vec3& position, EnvProbeState& state);

}  // namespace limn
