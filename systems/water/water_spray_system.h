#pragma once

#include "ecs/commands.h"
#include "ecs/components/time.h"
#include "ecs/components/water_spray.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/water/water_query.h"

namespace limn {

/// Adds SprayDrops to every spray source and obstacle that lacks them. Before update_spray, with a
/// sync point in between.
void add_spray_drops(
    Query<const SpraySource, Without<SprayDrops>> sources,
    Query<const SprayObstacle, Without<SprayDrops>, Without<SpraySource>> obstacles,
    Commands commands);

/// Emits the drops of this step at crests and at obstacles hit by waves. After fill_wave_tables.
void update_spray(
    WaterQuery waters, Query<const SpraySource, SprayDrops> sources,
    Query<const SprayObstacle, const WorldTransform, SprayDrops, Without<SpraySource>> obstacles,
    Res<const RandomSeed> seed, Res<const FrameTime> time);

}  // namespace limn
