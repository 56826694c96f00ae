#pragma once

#include "ecs/commands.h"
#include "ecs/components/ocean.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_spray.h"
#include "ecs/components/water_waves.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Gives SprayDrops to all that sprays. Before update_spray, with a sync point between.
void add_spray_drops(
    Query<const SpraySource, Without<SprayDrops>> sources,
    Query<const SprayObstacle, Without<SprayDrops>, Without<SpraySource>> obstacles,
    Commands commands);

/// The drops that begin in this step, of crests and of waves that hit obstacles. After
/// fill_wave_tables.
void update_spray(
    Query<
        const Water, const WorldTransform, const WaveTable, Optional<const OceanState>,
        Optional<const RippleState>, Optional<const SpraySource>, Optional<SprayDrops>>
        waters,
    Query<const SprayObstacle, const WorldTransform, SprayDrops, Without<SpraySource>> obstacles,
    Res<const RandomSeed> seed, Res<const FrameTime> time);

}  // namespace limn
