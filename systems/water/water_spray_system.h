#pragma once

#include "ecs/commands.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_ripples.h"
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

/// Emits the drops of this step at crests and where waves hit obstacles. After fill_wave_tables and
/// update_oceans.
void update_spray(
    WaterQuery waters, Query<const SpraySource, SprayDrops> sources,
    Query<
        const SprayObstacle, const WorldTransform, Optional<const PreviousWorldTransform>,
        Optional<const WaterTouch>, Optional<const TouchParts>, Optional<const ParticleCollider>,
        SprayDrops, Without<SpraySource>>
        obstacles,
    Res<const RandomSeed> seed, Res<const FrameTime> time);

}  // namespace limn
