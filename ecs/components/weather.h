#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cmath>

namespace limn {

/// Resource: wind and rain of the whole level. Sails feel the wind; every Ocean has its waves from
/// it, every WaterRipples its drops, and the lens, if there is LensRain, gets wet.
struct Weather {
    float wind_speed = 7.0f;      ///< 10 m above the water [m/s], 0 .. 60
    float wind_direction = 0.0f;  ///< where to, from +x toward +z [rad]
    float rain = 0.0f;            ///< 0 = none .. 1 = a downpour

    /// [m/s]
    [[nodiscard]] Vec3 wind() const {
        return wind_speed * Vec3(std::cos(wind_direction), 0, std::sin(wind_direction));
    }
};

inline constexpr float kStrongestWind = 20.0f;  ///< that keys reach [m/s]

template <typename Visitor>
void visit_fields(Weather& weather, Visitor&& visit) {
    visit(
        "wind_speed", weather.wind_speed,
        {.doc = "10 m above the water", .unit = "m/s", .min = 0, .max = 60});
    visit(
        "wind_direction", weather.wind_direction,
        {.doc = "where to, from +x toward +z", .unit = "rad", .min = -7, .max = 7});
    visit("rain", weather.rain, {.doc = "0 = none, 1 = a downpour", .min = 0, .max = 1});
}

}  // namespace limn
