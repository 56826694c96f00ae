#pragma once

#include "content/game/stones.h"
#include "ecs/commands.h"
#include "ecs/components/input.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/water/water_query.h"

namespace limn {

/// Gives each StoneThrower its state.
void add_stone_throwers(
    Query<const StoneThrower, Without<StoneThrowerState>> throwers, Commands commands);

/// Handles a click: each StoneThrower throws one stone, if the pointer is on water. Before
/// update_floating_bodies, with a sync point in between.
void throw_stones(
    Query<const StoneThrower, StoneThrowerState> throwers, Query<const ThrownStone> stones,
    WaterQuery waters, Query<RippleState> ripples, Res<Input> input, Commands commands);

/// Initial velocity of a ballistic flight from `from` to `to` [m/s], in the time that the straight
/// distance takes at `speed`.
[[nodiscard]] Vec3 velocity_to_hit(const Vec3& from, const Vec3& to, float speed);

}  // namespace limn
