#include "systems/water/weather_system.h"

#include "ecs/components/ocean.h"
#include "ecs/components/ripple.h"
#include "ecs/components/time.h"
#include "ecs/components/water_ripples.h"
#include "ecs/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

constexpr float kWindPace = 1.0f;   // [m/s^2]; all by eye
constexpr float kTurnPace = 0.25f;  // [rad/s]
// From one drawing of the spectra to the next: it costs some 30 ms.
constexpr std::uint64_t kSpectrumSteps = 4;
constexpr float kRainPace = 0.35f;  // [1/s]
constexpr float kDrops = 14.0f;     // that a downpour lets fall [1/(m^2 s)]
constexpr float kWetLens = 0.45f;   // of LensRain::amount

}  // namespace

Weather turn_weather(const Weather& weather, const Vec3& turn, float step) {
    Weather turned = weather;
    turned.wind_speed = std::clamp(
        turned.wind_speed + turn.y * kWindPace * step, 0.0f,
        std::max(turned.wind_speed, kStrongestWind));
    turned.wind_direction =
        std::remainder(turned.wind_direction + turn.x * kTurnPace * step, 2 * kPi);
    turned.rain = std::clamp(turned.rain + turn.z * kRainPace * step, 0.0f, 1.0f);
    return turned;
}

void update_weather(World& world) {
    const World& settings = world;
    const auto* weather = settings.find_resource<Weather>();
    const auto* input = settings.find_resource<Input>();
    const auto* time = settings.find_resource<FrameTime>();
    if (weather == nullptr || input == nullptr || time == nullptr) {
        return;
    }
    const Vec3& keys = input->weather;
    if (keys != Vec3(0) && std::isfinite(keys.x + keys.y + keys.z)) {
        const Vec3 turn = glm::clamp(input->weather, Vec3(-1), Vec3(1));
        *world.find_resource<Weather>() = turn_weather(*weather, turn, time->step);
    }
    const bool draws = time->frame % kSpectrumSteps == 0;
    world.query<Ocean>().each([&](Ocean& ocean) {
        if (!draws) {
            return;
        }
        ocean.wind_speed = weather->wind_speed;
        ocean.wind_direction = weather->wind_direction;
    });
    world.query<WaterRipples>().each(
        [&](WaterRipples& ripples) { ripples.rain = weather->rain * weather->rain * kDrops; });
    if (auto* lens = world.find_resource<LensRain>()) {
        lens->amount = weather->rain * kWetLens;
    }
}

}  // namespace limn
