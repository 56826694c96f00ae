#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cmath>

namespace limn {

/// Resource: wind and rain of the whole level. The wind drives sails and every Ocean; the rain
/// feeds every WaterRipples and, if present, LensRain. The player's changes are in WeatherState.
struct Weather {
    float wind_speed = 7.0f;
    float wind_direction = 0.0f;
    float rain = 0.0f;

    /// Wind velocity [m/s].
    [[nodiscard]] Vec3 wind() const {
        return wind_speed * Vec3(std::cos(wind_direction), 0, std::sin(wind_direction));
    }
};

LIMN_FIELDS(Weather) {
    LIMN_FIELD(wind_speed, "wind speed 10 m above the water", "m/s", 0, 60);
    LIMN_FIELD(wind_direction, "direction the wind blows toward, from +x toward +z", "rad", -7, 7);
    LIMN_FIELD(rain, "rain; 0 = none, 1 = downpour", "", 0, 1);
}

/// Resource: what Input has added to Weather.
struct WeatherState {
    float wind_speed = 0;
    float wind_direction = 0;
    float rain = 0;
};

LIMN_FIELDS(WeatherState) {
    LIMN_FIELD(wind_speed, "change of the wind speed by the player", "m/s");
    LIMN_FIELD(wind_direction, "change of the wind direction by the player", "rad");
    LIMN_FIELD(rain, "change of the rain by the player", "", -1, 1);
}

/// Settings and changes together.
[[nodiscard]] inline Weather current_weather(const Weather& weather, const WeatherState& state) {
    return {
        weather.wind_speed + state.wind_speed, weather.wind_direction + state.wind_direction,
        weather.rain + state.rain};
}

inline constexpr float kMaxWindSpeed = 20.0f;  ///< limit for the player [m/s]

}  // namespace limn
