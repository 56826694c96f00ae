#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/skin_pull.h"
#include "ecs/components/surface.h"
#include "ecs/query.h"
#include "ecs/system.h"

namespace limn {

/// Adds a DeformerState to every Deformers that lacks one, and a Deformed by itself to those of
/// them whose mesh no character deforms.
void add_deformer_states(
    Query<const Deformers, Without<DeformerState>> bare, Query<const Deformed> deformed,
    Commands commands);

/// Packs the controls, followed by the pulls of the character's skin; keeps those of the previous
/// step for velocities. In the first step, after a PoseCut, and where controls were added or
/// removed, both are the same.
void update_deformers(
    Query<const Deformers, DeformerState> deformers, Query<const Deformed> deformed,
    Query<const SkinPulls, const Deformed> pulled, Query<const PoseCut> cuts);

}  // namespace limn
