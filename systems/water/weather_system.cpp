#include "systems/water/weather_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

constexpr float kWindRate = 1.0f;   // [m/s^2]; all by eye
constexpr float kTurnRate = 0.25f;  // [rad/s]
// Steps between regenerations of the spectra, which cost some 30 ms.
constexpr std::uint64_t kSpectrumSteps = 4;
constexpr float kRainRate = 0.35f;  // [1/s]
constexpr float kDrops = 14.0f;     // drops of a downpour [1/(m^2 s)]
constexpr float kWetLens = 0.45f;   // LensRain::amount in a downpour

}  // namespace

Weather adjust_weather(const Weather& weather, const Vec3& turn, float step) {
    Weather turned = weather;
    turned.wind_speed = std::clamp(
        turned.wind_speed + turn.y * kWindRate * step, 0.0f,
        std::max(turned.wind_speed, kMaxWindSpeed));
    turned.wind_direction =
        std::remainder(turned.wind_direction + turn.x * kTurnRate * step, 2 * kPi);
    turned.rain = std::clamp(turned.rain + turn.z * kRainRate * step, 0.0f, 1.0f);
    return turned;
}

void update_weather(
    OptionalRes<const Weather> settings, Res<WeatherState> state, Res<const Input> input,
    Res<const FrameTime> time, Query<Ocean> oceans, Query<WaterRipples> pools,
    OptionalRes<LensRain> lens) {
    if (!settings) {
        return;
    }
    Weather weather = current_weather(*settings, std::as_const(*state));
    const Vec3 turn = {
        action_axis(*input, "wind_veer", "wind_back"),
        action_axis(*input, "wind_stronger", "wind_weaker"),
        action_axis(*input, "rain_more", "rain_less")};
    if (turn != Vec3(0) && std::isfinite(turn.x + turn.y + turn.z)) {
        weather = adjust_weather(weather, turn, time->step);
        *state = {
            weather.wind_speed - settings->wind_speed,
            weather.wind_direction - settings->wind_direction, weather.rain - settings->rain};
    }
    if (time->frame % kSpectrumSteps == 0) {
        oceans.each([&](Ocean& ocean) {
            ocean.wind_speed = weather.wind_speed;
            ocean.wind_direction = weather.wind_direction;
        });
    }
    pools.each([&](WaterRipples& ripples) { ripples.rain = weather.rain * weather.rain * kDrops; });
    if (lens) {
        lens->amount = weather.rain * kWetLens;
    }
}

}  // namespace limn
