#pragma once

#include "ecs/commands.h"
#include "ecs/components/motor.h"
#include "ecs/components/time.h"
#include "ecs/system.h"
#include "systems/characters/grounds.h"
#include "systems/water/water_query.h"

#include <span>

namespace limn {

/// A loose body in one step.
struct LooseStep {
    Vec3 position = Vec3(0);
    Vec3 velocity = Vec3(0);
    Quat rotation = {1, 0, 0, 0};
};

/// Falls, bounces off what is Walkable, rolls with friction and floats, for `dt` >= 0 [s]. Nothing
/// that is not finite comes out of what is finite.
[[nodiscard]] LooseStep step_loose_body(
    const LooseBody& body, const LooseStep& last, std::span<const PlacedGround> grounds,
    std::span<const WaterSurface> waters, float dt);

void add_loose_states(Query<const LooseBody, Without<LooseState>> bare, Commands commands);

/// After update_motors, whose characters push them. They push each other apart, too.
void update_loose_bodies(
    Query<const LooseBody, LooseState, Transform, Without<Parent>> bodies,
    Query<const CharacterMotor, const MotorState, Optional<const Hero>> motors,
    GroundQueries grounds, WaterQuery waters, Res<const FrameTime> time);

}  // namespace limn
