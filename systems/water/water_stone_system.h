#pragma once

#include "ecs/commands.h"
#include "ecs/components/input.h"
#include "ecs/components/ocean.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_stones.h"
#include "ecs/components/water_waves.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Takes a click: one stone for each StoneThrower, if the pointer is on water. Before
/// update_floating_bodies, which lets them fly from the next step on.
void throw_stones(
    Query<StoneThrower> throwers, Query<const ThrownStone> stones,
    Query<
        const Water, const WorldTransform, Optional<const OceanState>, Optional<const WaveTable>,
        Optional<RippleState>>
        waters,
    Res<Input> input, Commands commands);

/// Velocity with which what falls freely from `from` is at `to` after the time that it takes at
/// `speed` along the straight way [m/s].
[[nodiscard]] Vec3 velocity_to_hit(const Vec3& from, const Vec3& to, float speed);

}  // namespace limn
