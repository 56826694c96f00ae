#include "ecs/components/ocean.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_ripples.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/water_dispersion.h"
#include "systems/water/water_query.h"
#include "systems/water/water_spray_drops.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::water_spray_test {

namespace {

struct Sea {
    explicit Sea(const WaterWave& wave, double time = 0.4) {
        fill_wave_table({}, {.waves = {wave}}, time, waves);
        surface.waves = &waves;
    }
    [[nodiscard]] const WaveLine& line() const { return waves.lines[0]; }
    WaveTable waves;
    WaterSurface surface;
};

WaterWave wave_of(float steepness, float length = 10) {
    return {.amplitude = 0.5f * steepness * length, .length = length, .direction = 0.7f};
}

}  // namespace

TEST_CASE(
    "water spray: at a crest water moves at pi S times the wave's speed"
    * technique("water.crest-spray")) {
    const auto speed = static_cast<float>(phase_speed(2 * 3.14159265358979 / 10, 1e9));
    CHECK(speed == test::near(3.951342).epsilon(1e-6).scale(0));
    CHECK(orbital_speed(1, 10, speed) == test::near(1.241351).epsilon(1e-6).scale(0));
    CHECK(orbital_speed(1, 10, speed) / speed == test::near(0.314159).epsilon(1e-5).scale(0));
    const Sea sea(wave_of(0.1f));
    CHECK(steepness(sea.line()) == test::near(0.1));
    CHECK(orbital_speed(sea.line()) == test::near(1.241351).epsilon(1e-5).scale(0));
    // A cusp, Q k A = 1 with Q = 1, is as steep as 1 / pi: there water is as fast as the wave.
    const Sea cusp({.amplitude = 10 / (2 * kPi), .length = 10, .sharpness = 1});
    CHECK(steepness(cusp.line()) == test::near(0.318310).epsilon(1e-5).scale(0));
    CHECK(orbital_speed(cusp.line()) == test::near(speed));
}

TEST_CASE(
    "water spray: waves that are not steep enough do not spray" * technique("water.crest-spray")) {
    constexpr float kOfBook = 0.31831f;
    struct Case {
        float wave;
        float limit;
        bool breaks;
    };
    for (const Case& c :
         {Case{0.1f, kOfBook, false}, Case{0.319f, kOfBook, true}, Case{0.09f, 0.1f, false},
          Case{0.11f, 0.1f, true}}) {
        const Sea sea(wave_of(c.wave));
        std::vector<SprayDrop> drops;
        Random random(1, 2, 3, 4);
        spray_crests(sea.surface, {.steepness = c.limit, .rate = 1000}, 0.1f, random, drops);
        CHECK(drops.empty() != c.breaks);
    }
}

TEST_CASE(
    "water spray: drops start near crests, not in rows, and move along the wave"
    * technique("water.crest-spray")) {
    for (const float lean : {0.0f, 0.5f}) {
        WaterWave wave = wave_of(0.12f);
        wave.lean = lean;
        const Sea sea(wave);
        std::vector<SprayDrop> drops;
        Random random(1, 2, 3, 4);
        spray_crests(sea.surface, {.rate = 4000}, 1, random, drops);
        REQUIRE(drops.size() > 3000);
        const Vec3 along = {std::cos(0.7f), 0, std::sin(0.7f)};
        float mean = 0;
        float square = 0;  // of speeds, in the mean
        float least = 100;
        float greatest = 0;
        for (const SprayDrop& drop : drops) {
            CHECK(drop.position.y >= 0.95f * wave.amplitude);
            CHECK(std::abs(drop.position.x) <= 30);
            const float speed = glm::length(drop.velocity);
            if (speed > 0.01f) {
                CHECK(glm::dot(drop.velocity / speed, along) > std::cos(0.3f) - 1e-4f);
            }
            mean += speed / static_cast<float>(drops.size());
            square += speed * speed / static_cast<float>(drops.size());
            least = std::min(least, drop.position.y);
            greatest = std::max(greatest, drop.position.y);
        }
        CHECK(std::abs(mean / orbital_speed(sea.line()) - 1) < 0.02f);
        CHECK(std::sqrt(square - mean * mean) / mean == test::near(0.2).epsilon(0.1));  // `spread`
        CHECK(greatest - least > 0.02f * wave.amplitude);
    }
}

TEST_CASE(
    "water spray: the number of drops follows the rate, for any step length"
    * technique("water.crest-spray")) {
    const Sea sea(wave_of(0.2f));
    for (const float step : {0.001f, 0.01f}) {
        std::vector<SprayDrop> drops;
        SpraySource source{.rate = 250};
        source.window = {1000, 1000};  // hardly any beyond the edge
        const int steps = static_cast<int>(10 / step);
        for (int i = 0; i < steps; ++i) {
            Random random(1, 2, 3, static_cast<std::uint64_t>(i));
            spray_crests(sea.surface, source, step, random, drops);
        }
        CHECK(std::abs(static_cast<float>(drops.size()) / 2500 - 1) < 0.06f);
    }
}

TEST_CASE(
    "water spray: an ocean emits drops where it breaks, at the speed of its water"
    * technique("water.crest-spray")) {
    // A patch of 16 m that moves with (3, 4, 0) m/s; its half with x > 8 m is pressed together.
    OceanState ocean{.made_for = {.foam_threshold = 0.9f}, .step = 0.5f, .cascades = {}};
    OceanCascade& cascade = ocean.cascades.emplace_back();
    cascade.size = 16;
    cascade.patch = 16;
    const std::vector<float> flat(16 * 16, 0.0f);
    cascade.height = cascade.shift_x = cascade.shift_z = cascade.slope_x = cascade.slope_z =
        cascade.shift_xx = cascade.shift_zz = cascade.shift_xz = cascade.previous_height =
            cascade.previous_shift_x = cascade.previous_shift_z = flat;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        cascade.height[i] = 1;
        cascade.previous_height[i] = -1;
        cascade.previous_shift_x[i] = -1.5f;
        cascade.shift_xx[i] = i % 16 > 8 ? -0.5f : 0.0f;
    }
    WaterSurface surface;
    surface.ocean = &ocean;
    const SpraySource source = {.rate = 2000, .spread = 0, .window = {20, 16}};
    const auto spray = [&] {
        std::vector<SprayDrop> drops;
        Random random(1, 2, 3, 4);
        spray_breakers(surface, source, 1, random, drops);
        return drops;
    };
    const std::vector<SprayDrop> drops = spray();
    // 6400 tries along 20 m. From -7 to -1 and from 9 to 10 m, J is 0.5 and the chance 0.4; beside
    // that it rises over 0.8 m, thrice.
    const double expected = 6400 * (7 * 0.4 + 3 * 0.5 * 0.8 * 0.4) / 20;
    CHECK(static_cast<double>(drops.size()) == test::near(expected).epsilon(0.1).scale(0));
    for (const SprayDrop& drop : drops) {
        const float x = drop.position.x < 0 ? drop.position.x + 16 : drop.position.x;
        CHECK(x > 8.19f);
        CHECK(x < 15.81f);
        CHECK(drop.position.y == 1);
        CHECK(glm::length(drop.velocity) == test::near(5));
        CHECK(glm::dot(drop.velocity, Vec3(0.6f, 0.8f, 0)) > 5 * std::cos(source.angle) - 1e-3f);
    }
    ocean.made_for.foam_threshold = 0.5f;  // it is pressed together as far, and no farther
    CHECK(spray().empty());
    // Sheared by as much in both directions: J is 1 - 0.5^2.
    ocean.made_for.foam_threshold = 0.9f;
    cascade.shift_xx = flat;
    cascade.shift_xz.assign(flat.size(), 0.5f);
    CHECK(static_cast<double>(spray().size()) == test::near(6400 * 0.15).epsilon(0.1).scale(0));
}

TEST_CASE(
    "water spray: a wall sprays most at a crest, and not a quarter wave later"
    * technique("water.impact-spray")) {
    CHECK(impact_share(0) == 1);
    CHECK(impact_share(0.5f * kPi) < 1e-20f);
    CHECK(impact_share(2) == 0);
    CHECK(impact_share(kPi / 3) == test::near(1.0 / 16));
    CHECK(impact_share(-0.3f) == impact_share(0.3f));
    const WaterWave wave = {.amplitude = 0.5f, .length = 10};  // along +x
    const auto drops_at = [&](float x, const Vec3& normal) {
        Sea sea(wave, 0);  // its crest is at x = 2.5
        std::vector<SprayDrop> drops;
        Random random(1, 2, 3, 4);
        spray_impact(sea.surface, {.rate = 5000}, {x, 0.2f, 3}, normal, 1, random, drops);
        return drops;
    };
    CHECK(drops_at(2.5f, {-1, 0, 0}).size() == 5000);
    CHECK(drops_at(5.0f, {-1, 0, 0}).empty());
    CHECK(drops_at(0.0f, {-1, 0, 0}).empty());
    CHECK(drops_at(2.5f, {1, 0, 0}).empty());  // it runs away from this side
    CHECK(drops_at(2.5f, {0, 0, 1}).empty());
}

TEST_CASE(
    "water spray: a wall throws drops back at about the speed of the water"
    * technique("water.impact-spray")) {
    Sea sea({.amplitude = 0.5f, .length = 10}, 0);
    const Vec3 normal = glm::normalize(Vec3(-1, 0.1f, 0.8f));
    const SprayObstacle obstacle = {.rate = 10000};
    std::vector<SprayDrop> drops;
    Random random(1, 2, 3, 4);
    spray_impact(sea.surface, obstacle, {2.5f, 0, 0}, normal, 1, random, drops);
    REQUIRE(drops.size() == 10000);
    const Vec3 ideal = Vec3(1, 0, 0) - 2 * normal.x * normal;
    double mean = 0;
    for (const SprayDrop& drop : drops) {
        const float speed = glm::length(drop.velocity);
        CHECK(glm::dot(drop.velocity, ideal) >= (std::cos(obstacle.angle) - 1e-4f) * speed);
        CHECK(glm::dot(drop.velocity, normal) >= -1e-6f);
        CHECK(drop.position.y == test::near(0.5));
        mean += static_cast<double>(speed) / 10000;
    }
    CHECK(std::abs(mean / static_cast<double>(orbital_speed(sea.line())) - 1) < 0.02);
    // A wall that the wave only grazes keeps them on its side.
    drops.clear();
    const Vec3 grazed = glm::normalize(Vec3(-0.1f, 0, 1));
    spray_impact(sea.surface, obstacle, {2.5f, 0, 0}, grazed, 1, random, drops);
    for (const SprayDrop& drop : drops) {
        CHECK(glm::dot(drop.velocity, grazed) >= -1e-6f);
    }
}

TEST_CASE(
    "water spray: an ocean sprays at a wall while its water runs against it"
    * technique("water.impact-spray")) {
    World world;
    Schedule schedule = make_world_schedule();
    const Entity water =
        world.create(Transform{}, Water{}, Ocean{.wind_speed = 14, .resolution = 64});
    const SprayObstacle wall = {.normal = {-1, 0, 0}, .rate = 4000};
    const Entity point = world.create(Transform{.position = {3, 0, 2}}, wall);
    start_world(world);
    std::size_t all = 0;
    int silent = 0;
    for (int i = 0; i < 400; ++i) {
        step_world(world, schedule);
        const auto surfaces = [&] {
            std::vector<WaterSurface> found;
            world.run([&](WaterQuery waters) { found = collect_water_surfaces(waters); });
            return found;
        }();
        REQUIRE(surfaces.size() == 1);
        const WaterPoint top = sample_water(surfaces[0], {3, 2});
        const std::vector<SprayDrop>& drops = world.get<const SprayDrops>(point).drops;
        if (top.velocity.x <= 0) {
            CHECK(drops.empty());  // it recedes
        }
        const float crest = surge_speed(surfaces[0], {3, 2});
        const float expected = 4000 * surge_share(top.velocity.x, crest) / 60;
        CHECK(std::abs(static_cast<float>(drops.size()) - expected) <= 1);
        for (const SprayDrop& drop : drops) {
            CHECK(drop.velocity.x <= 1e-5f);  // off the wall
            CHECK(drop.position.y == test::near(static_cast<double>(top.position.y)).epsilon(1e-5));
        }
        all += drops.size();
        silent += drops.empty() ? 1 : 0;
    }
    CHECK(all > 500);
    CHECK(silent > 150);
    CHECK(world.alive(water));
}

TEST_CASE("water spray: in a single wave the speed in crests is its orbital speed, and at the "
          "crest the share is 1") {
    const Sea sea({.amplitude = 0.8f, .length = 11});
    CHECK(
        surge_speed(sea.surface, {0, 0})
        == test::near(static_cast<double>(orbital_speed(sea.line()))).epsilon(0.1));
    const float q = orbital_speed(sea.line());
    for (const float phase : {-2.0f, -1.0f, 0.0f, 0.4f, 1.5f, 3.0f}) {
        CHECK(
            surge_share(q * std::cos(phase), q)
            == test::near(static_cast<double>(impact_share(phase))).scale(1).epsilon(1e-4));
    }
    CHECK(surge_share(0.5f, 0.1f) == 0.0625f);  // ripples are too slow
}

TEST_CASE(
    "water spray: a body is wet where waves come from, and only at its waterline"
    * technique("water.impact-spray")) {
    // Along +x.
    Sea sea({.amplitude = 0.8f, .length = 12}, 0);
    sea.surface.water.size = {80, 80};
    Random random(1, 2, 3, 4);
    for (const bool is_box : {false, true}) {
        CAPTURE(is_box);
        std::vector<SprayDrop> drops;
        const Affine at = affine_from({2.5f, 0.2f, 1}, Quat(1, 0, 0, 0), Vec3(1));
        const SprayBody body = {.is_box = is_box, .half = {1, 1.5f, 2}, .world = at, .before = at};
        const float crest = surge_speed(sea.surface, {2.5f, 1});
        for (int i = 0; i < 120; ++i) {
            fill_wave_table(
                {}, {.waves = {{.amplitude = 0.8f, .length = 12}}}, i / 30.0, sea.waves);
            spray_body(sea.surface, {.rate = 4000}, body, crest, 1.0f / 60, random, drops);
        }
        REQUIRE(drops.size() > 300);
        std::size_t windward = 0;
        for (const SprayDrop& drop : drops) {
            const Vec3 local = drop.position - Vec3(2.5f, 0.2f, 1);
            CHECK(std::abs(local.x) <= 1.0001f);
            CHECK(std::abs(local.z) <= 2.0001f);
            CHECK(std::abs(local.y) <= 1.5f);
            CHECK(drop.velocity.y > 0);
            windward += local.x < 0 ? 1 : 0;
        }
        // In troughs water runs back and hits the other side.
        CHECK(windward > drops.size() / 4);
        CHECK(windward < drops.size());
        drops.clear();
        SprayBody high = body;
        high.world = high.before = affine_from({2.5f, 9, 1}, Quat(1, 0, 0, 0), Vec3(1));
        spray_body(sea.surface, {.rate = 4000}, high, crest, 1, random, drops);
        high.world = high.before = affine_from({2.5f, -9, 1}, Quat(1, 0, 0, 0), Vec3(1));
        spray_body(sea.surface, {.rate = 4000}, high, crest, 1, random, drops);
        CHECK(drops.empty());
    }
}

TEST_CASE(
    "water spray: where waves hit a body, drops are as fast as the water on its orbit"
    * technique("water.impact-spray")) {
    // In deep water orbits are circles: at each phase the speed is A omega, up, along or down.
    for (const float direction : {0.0f, 0.9f}) {
        CAPTURE(direction);
        const WaterWave wave = {.amplitude = 0.8f, .length = 12, .direction = direction};
        Sea sea(wave, 0);
        Random random(1, 2, 3, 4);
        std::vector<SprayDrop> drops;
        const Affine at = affine_from({1, 0, -2}, Quat(1, 0, 0, 0), Vec3(1));
        const SprayBody body = {.half = {1.5f, 2, 1.5f}, .world = at, .before = at};
        for (int i = 0; i < 120; ++i) {
            fill_wave_table({}, {.waves = {wave}}, i / 30.0, sea.waves);
            spray_body(
                sea.surface, {.rate = 4000, .spread = 0}, body, orbital_speed(sea.line()),
                1.0f / 60, random, drops);
        }
        REQUIRE(drops.size() > 300);
        for (const SprayDrop& drop : drops) {
            CHECK(
                glm::length(drop.velocity)
                == test::near(static_cast<double>(orbital_speed(sea.line()))).epsilon(1e-3));
        }
    }
}

TEST_CASE(
    "water spray: a hull that runs through still water throws up a bow wave, at rest nothing"
    * technique("water.impact-spray")) {
    WaterSurface still;
    still.water.size = {100, 100};
    Random random(1, 2, 3, 4);
    std::vector<SprayDrop> drops;
    SprayBody hull = {.half = {0.6f, 0.5f, 2}};
    for (int i = 0; i < 60; ++i) {
        spray_body(still, {.rate = 2000}, hull, 0, 1.0f / 60, random, drops);
    }
    CHECK(drops.empty());
    hull.before = affine_from({0, 0, -4.0f / 60}, Quat(1, 0, 0, 0), Vec3(1));  // 4 m/s along +z
    for (int i = 0; i < 60; ++i) {
        spray_body(still, {.rate = 2000}, hull, 0, 1.0f / 60, random, drops);
    }
    REQUIRE(drops.size() > 200);
    for (const SprayDrop& drop : drops) {
        CHECK(drop.position.z > 0);  // at the bow
        CHECK(drop.velocity.y > 0);
    }
    // Aslant, wherever it throws them: none into the hull.
    drops.clear();
    hull.is_box = true;
    hull.before = affine_from({-2.5f / 60, 0, -2.5f / 60}, Quat(1, 0, 0, 0), Vec3(1));
    for (int i = 0; i < 60; ++i) {
        spray_body(still, {.rate = 2000, .angle = 1.4f}, hull, 0, 1.0f / 60, random, drops);
    }
    std::size_t at_side = 0;
    for (const SprayDrop& drop : drops) {
        const bool is_side = drop.position.x > 0.5999f;
        CHECK((is_side ? drop.velocity.x : drop.velocity.z) >= -1e-5f);
        at_side += is_side ? 1 : 0;
    }
    // As many more as that side is longer.
    CHECK(drops.size() > 200);
    CHECK(
        static_cast<double>(at_side) / static_cast<double>(drops.size())
        == test::near(2 / 2.6).epsilon(0.1));
    drops.clear();
    hull.is_box = false;
    for (int i = 0; i < 60; ++i) {
        spray_body(still, {.rate = 2000, .angle = 1.4f}, hull, 0, 1.0f / 60, random, drops);
    }
    CHECK(drops.size() > 100);
    for (const SprayDrop& drop : drops) {
        const Vec3 outward = drop.position / (hull.half * hull.half);
        CHECK(glm::dot(glm::normalize(Vec3(outward.x, 0, outward.z)), drop.velocity) >= -1e-5f);
    }
}

TEST_CASE(
    "water spray: how hard a body is hit does not depend on what stands far away"
    * technique("water.impact-spray")) {
    const auto drops_with = [](const Vec3& first) {
        World world;
        Schedule schedule = make_world_schedule();
        world.create(
            Transform{}, Water{.size = {60, 60}},
            WaterWaves{.waves = {{.amplitude = 0.9f, .length = 14}}});
        const ParticleCollider box = {.shape = ColliderShape::Box, .size = {1, 2, 1}};
        const SprayObstacle obstacle = {.rate = 3000};
        world.create(Transform{.position = first}, obstacle, box);
        const Entity near =
            world.create(Transform{.position = {1, 0, 2}}, SprayObstacle{.rate = 3000}, box);
        start_world(world);
        std::size_t sum = 0;
        for (int i = 0; i < 120; ++i) {
            step_world(world, schedule);
            sum += world.get<SprayDrops>(near).drops.size();
        }
        return sum;
    };
    const std::size_t alone = drops_with({-28, 0, 2});
    CHECK(alone > 100);
    CHECK(drops_with({500, 0, 0}) == alone);  // on land, where nothing surges
}

namespace {

void move_obstacles(Query<const SprayObstacle, Transform> obstacles) {
    obstacles.each([](const SprayObstacle&, Transform& pose) { pose.position.x += 3; });
}

void add_moving_obstacles(SystemList& systems) {
    systems.add<move_obstacles>(Phase::Move);
}

}  // namespace

TEST_CASE("water spray: drops leave a moving body where it is in this step") {
    World world;
    Schedule schedule = make_world_schedule(add_moving_obstacles);
    world.create(Transform{}, Water{}, WaterWaves{.waves = {wave_of(0.15f)}});
    const Entity wall =
        world.create(Transform{}, SprayObstacle{.normal = {-1, 0, -1}, .rate = 6000});
    start_world(world, add_moving_obstacles);
    std::size_t thrown = 0;
    for (int i = 0; i < 60; ++i) {
        step_world(world, schedule);
        const float x = world.get<Transform>(wall).position.x;
        for (const SprayDrop& drop : world.get<SprayDrops>(wall).drops) {
            CHECK(std::abs(drop.position.x - x) < 0.5f);
            ++thrown;
        }
    }
    CHECK(thrown > 100);
}

TEST_CASE("water spray: what runs through still water throws as much in one part as in several") {
    World world;
    Schedule schedule = make_world_schedule(add_moving_obstacles);
    world.create(Transform{}, Water{});
    const Vec3 half(0.5f);
    const SprayObstacle obstacle = {.rate = 3000};
    const Entity whole = world.create(Transform{}, obstacle, WaterTouch{.half = half});
    const TouchParts parts = {.parts = std::vector<TouchPart>(4, {.half = half})};
    const Entity several = world.create(
        Transform{.position = {0, 0, 40}}, obstacle, WaterTouch{.shape = TouchShape::Mesh}, parts);
    start_world(world, add_moving_obstacles);
    std::size_t thrown[2] = {0, 0};
    for (int i = 0; i < 60; ++i) {
        step_world(world, schedule);
        thrown[0] += world.get<SprayDrops>(whole).drops.size();
        thrown[1] += world.get<SprayDrops>(several).drops.size();
    }
    CHECK(thrown[0] > 200);
    CHECK(
        static_cast<double>(thrown[1])
        == test::near(static_cast<double>(thrown[0])).epsilon(0.15).scale(0));
}

TEST_CASE("water spray: a bowl, which has no outside, is hit at its point") {
    World world;
    Schedule schedule = make_world_schedule();
    world.create(Transform{}, Water{}, WaterWaves{.waves = {wave_of(0.2f)}});
    const SprayObstacle obstacle = {.normal = {-1, 0, -1}, .rate = 4000};
    const auto collider = [](bool hollow) {
        return ParticleCollider{
            .shape = ColliderShape::Sphere, .size = {2, 0, 0}, .hollow = hollow};
    };
    const Entity bowl = world.create(Transform{}, obstacle, collider(true));
    const Entity ball = world.create(Transform{}, obstacle, collider(false));
    start_world(world);
    std::size_t thrown[2] = {0, 0};
    for (int i = 0; i < 120; ++i) {
        step_world(world, schedule);
        for (const SprayDrop& drop : world.get<SprayDrops>(bowl).drops) {
            CHECK(std::hypot(drop.position.x, drop.position.z) < 1e-4f);
            ++thrown[0];
        }
        for (const SprayDrop& drop : world.get<SprayDrops>(ball).drops) {
            CHECK(std::hypot(drop.position.x, drop.position.z) > 1.5f);
            ++thrown[1];
        }
    }
    CHECK(thrown[0] > 100);
    CHECK(thrown[1] > 100);
}

TEST_CASE("water spray: a world refills its drops each step" * technique("water.crest-spray")) {
    World world;
    Schedule schedule = make_world_schedule();
    const Entity water = world.create(
        Transform{.position = {0, 5, 0}}, Water{}, WaterWaves{.waves = {wave_of(0.15f)}},
        SpraySource{.rate = 600});
    const Entity wall = world.create(
        Transform{.position = {0, 5, 0}}, SprayObstacle{.normal = {-1, 0, -1}, .rate = 6000});
    const Entity high = world.create(
        Transform{.position = {0, 9, 0}}, SprayObstacle{.normal = {-1, 0, -1}, .rate = 6000});
    start_world(world);
    std::size_t of_wall = 0;
    for (int i = 0; i < 200; ++i) {
        step_world(world, schedule);
        const std::size_t drops = world.get<SprayDrops>(water).drops.size();
        CHECK(drops <= 11);
        CHECK(drops + 6 >= 10);
        of_wall += world.get<SprayDrops>(wall).drops.size();
        CHECK(world.get<SprayDrops>(high).drops.empty());
    }
    // The mean of cos^4 is 3/8, over half of the time: of 6000 / 60 per step.
    CHECK(std::abs(static_cast<float>(of_wall) / (200 * 100) - 3.0f / 16) < 0.06f);
}

}  // namespace limn::water_spray_test
