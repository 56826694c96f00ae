#pragma once

#include "ecs/components/input.h"
#include "ecs/components/ocean.h"
#include "ecs/components/ripple.h"
#include "ecs/components/time.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/weather.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Applies the player's actions to WeatherState, and the current weather to its dependents: wind to
/// every Ocean, rain to every WaterRipples and to LensRain. Does nothing without Weather. The
/// random numbers of ocean waves are kept: existing waves grow with the wind. Before everything
/// that moves water.
void update_weather(
    OptionalRes<const Weather> settings, Res<WeatherState> state, Res<const Input> input,
    Res<const FrameTime> time, Query<Ocean> oceans, Query<WaterRipples> pools,
    OptionalRes<LensRain> lens);

/// The weather after `step` [s] of `turn`: direction, speed and rain, -1 .. 1.
[[nodiscard]] Weather adjust_weather(const Weather& weather, const Vec3& turn, float step);

}  // namespace limn
