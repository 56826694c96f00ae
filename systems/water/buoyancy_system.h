#pragma once

#include "ecs/commands.h"
#include "ecs/components/buoyancy.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/water/water_query.h"

namespace limn {

/// Gives each Floating its state.
void add_floating_states(Query<const Floating, Without<FloatingState>> bodies, Commands commands);

/// Advances all floating bodies by a step, with the water at the end of the step. Bodies that hit
/// the water add impulses to its ripples, and bodies that touch push
/// one another. After everything that moves water, before
/// update_transforms.
void update_floating_bodies(
    WaterQuery waters, Query<RippleState> ripples,
    Query<const WaterTouch, const Floating, FloatingState, Transform, Without<Parent>> bodies,
    Res<const FrameTime> time);

}  // namespace limn
