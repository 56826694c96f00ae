#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/ocean.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_walls.h"
#include "ecs/components/water_waves.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Adds a RippleState at rest to every Water with WaterRipples that lacks one. Before
/// update_water_ripples, with a sync point in between.
void add_ripple_states(
    Query<const Water, const WaterRipples, Without<RippleState>> bare, Res<const FrameTime> time,
    Commands commands);

/// Applies walls, bodies and rain, then advances the wave equation by a step. A state whose grid no
/// longer matches the settings is recreated at rest.
void update_water_ripples(
    Query<
        const Water, const WaterRipples, const WorldTransform, Optional<const OceanState>,
        Optional<const WaveTable>, RippleState>
        waters,
    Query<
        const WaterTouch, const WorldTransform, Optional<const TouchParts>,
        Optional<const Deformed>>
        bodies,
    Query<const Pose> poses, Query<const WaterWall, const WorldTransform> walls,
    Res<const Assets> assets, Res<const RandomSeed> seed, Res<const FrameTime> time);

}  // namespace limn
