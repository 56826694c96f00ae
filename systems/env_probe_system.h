#pragma once

#include "ecs/commands.h"
#include "ecs/components/env_probe.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"

namespace limn {

// Decides when probes look around again (env.update-policy); the renderer draws the faces that are
// due. A frame is a step of the world. Changes around a probe that stands still are seen only by
// its period.

/// Gives each EnvProbe its state.
void add_env_probe_states(Query<const EnvProbe, Without<EnvProbeState>> probes, Commands commands);

/// Runs after update_transforms: a probe looks from where its entity is now.
void update_env_probes(Query<const EnvProbe, const WorldTransform, EnvProbeState> probes);

/// One frame of one probe, which is at `position`.
void step_env_probe(const EnvProbe& probe, const Vec3& position, EnvProbeState& state);

}  // namespace limn
