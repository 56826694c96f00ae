#pragma once

#include "ecs/entity.h"

namespace limn {

class World;

/// Removes the particles. The emitter starts again in the next step, prewarmed if it is set so.
void restart_emitter(World& world, Entity emitter);

/// From now on an emitter whose seed is edited, undone or reloaded restarts (ecs/field_watch.h).
/// Runs at the start. Exclusive.
void watch_emitter_seeds(World& world);

}  // namespace limn
