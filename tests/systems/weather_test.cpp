#include "ecs/components/all.h"
#include "ecs/components/input.h"
#include "ecs/components/ocean.h"
#include "ecs/components/ripple.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/weather.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/weather_system.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::weather_test {

namespace {

struct Bay {
    World world;
    Schedule schedule = make_world_schedule();
    Entity sea;
    Entity pool;

    explicit Bay(bool with_weather = true) {
        register_all_components();
        if (with_weather) {
            world.insert_resource(Weather{.wind_speed = 7, .wind_direction = 0.5f});
        }
        world.insert_resource(LensRain{.amount = 0.1f});
        sea = world.create(
            Transform{}, WorldTransform{}, Water{},
            Ocean{.wind_speed = 5, .cascades = 1, .patch = 80, .resolution = 32});
        pool = world.create(
            Transform{.position = {0, 9, 0}}, WorldTransform{}, Water{.size = {4, 4}},
            WaterRipples{.cell = 0.2f, .rain = 0.3f});
        start_world(world);
    }
    void run(int steps, const Vec3& turn = Vec3(0)) {
        Input& input = world.resource<Input>();
        set_action(input, "wind_veer", turn.x);
        set_action(input, "wind_stronger", turn.y);
        set_action(input, "rain_more", turn.z);
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    [[nodiscard]] const std::vector<float>& heights() {
        return world.get<OceanState>(sea).cascades[0].height;
    }
};

double rms(const std::vector<float>& values) {
    double sum = 0;
    for (const float x : values) {
        sum += static_cast<double>(x) * static_cast<double>(x);
    }
    return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

TEST_CASE("weather: a level without weather keeps its own wind and rain") {
    Bay bay(false);
    bay.run(10, {1, 1, 1});
    CHECK(bay.world.get<Ocean>(bay.sea).wind_speed == 5);
    CHECK(bay.world.get<WaterRipples>(bay.pool).rain == 0.3f);
    CHECK(bay.world.resource<LensRain>().amount == 0.1f);
    CHECK(bay.world.find_resource<Weather>() == nullptr);
}

TEST_CASE("weather: oceans have its wind, pools its rain, the lens its drops") {
    Bay bay;
    CHECK(bay.world.get<Ocean>(bay.sea).wind_speed == 7);
    CHECK(bay.world.get<WaterRipples>(bay.pool).rain == 0);
    CHECK(bay.world.resource<LensRain>().amount == 0);
    bay.run(180, {1, -1, 1});
    bay.run(8);
    const Weather weather =
        current_weather(bay.world.resource<Weather>(), bay.world.resource<WeatherState>());
    CHECK(weather.wind_speed == test::near(4).epsilon(0.02));
    CHECK(weather.wind_direction == test::near(1.25).epsilon(0.01));
    CHECK(weather.rain > 0.4f);
    CHECK(bay.world.get<Ocean>(bay.sea).wind_speed == weather.wind_speed);
    CHECK(bay.world.get<WaterRipples>(bay.pool).rain > 1);
    CHECK(bay.world.resource<LensRain>().amount > 0.1f);
}

TEST_CASE("weather: keys change it only between calm and storm") {
    Weather weather;
    for (int i = 0; i < 2000; ++i) {
        weather = adjust_weather(weather, {1, 1, 1}, 1.0f / 60);
    }
    CHECK(weather.wind_speed == kMaxWindSpeed);
    CHECK(weather.rain == 1);
    CHECK(std::abs(weather.wind_direction) <= kPi + 1e-5f);
    for (int i = 0; i < 2000; ++i) {
        weather = adjust_weather(weather, {-1, -1, -1}, 1.0f / 60);
    }
    CHECK(weather.wind_speed == 0);
    CHECK(weather.rain == 0);
}

TEST_CASE("weather: as the wind turns and increases the sea follows without a jump") {
    Bay bay;
    bay.run(30);
    const auto largest_step = [&bay](int steps, const Vec3& turn) {
        double largest = 0;
        for (int i = 0; i < steps; ++i) {
            const std::vector<float> before = bay.heights();
            bay.run(1, turn);
            std::vector<float> change = bay.heights();
            for (std::size_t k = 0; k < change.size(); ++k) {
                change[k] -= before[k];
            }
            largest = std::max(largest, rms(change) / rms(bay.heights()));
        }
        return largest;
    };
    const double calm_before = rms(bay.heights());
    const double steady = largest_step(60, Vec3(0));
    const double turning = largest_step(240, {0.6f, 1, 0});
    MESSAGE("a step changes the heights by " << steady << ", with the wind by " << turning);
    CHECK(turning < 3 * steady);
    CHECK(rms(bay.heights()) > 1.5 * calm_before);
}

}  // namespace limn::weather_test
