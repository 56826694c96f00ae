#pragma once

#include "ecs/components/input.h"
#include "ecs/components/weather.h"

namespace limn {

class World;

/// Lets Input turn the weather, and everything follow it: the waves of every Ocean are those of the
/// wind, drops fall on every WaterRipples, the lens gets wet. Where a level has no Weather,
/// nothing. The numbers that each wave of an ocean has drawn stay: as the wind grows, so do the
/// waves that are there. First of all that moves water.
void update_weather(World& world);

/// The weather after `step` [s] of Input::weather.
[[nodiscard]] Weather turn_weather(const Weather& weather, const Vec3& turn, float step);

}  // namespace limn
