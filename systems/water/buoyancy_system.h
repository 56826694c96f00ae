#pragma once

#include "ecs/components/buoyancy.h"
#include "ecs/components/ocean.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_waves.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Moves all floating bodies by a step, in the water as it is at the end of it; those that fall in
/// splash: they add impulses to the ripples of that water. After what moves the water, before
/// update_transforms.
void update_floating_bodies(
    Query<
        const Water, const WorldTransform, Optional<const OceanState>, Optional<const WaveTable>,
        Optional<RippleState>>
        waters,
    Query<const WaterTouch, Floating, Transform, Without<Parent>> bodies,
    Res<const FrameTime> time);

}  // namespace limn
