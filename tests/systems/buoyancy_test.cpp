#include "ecs/base/jobs.h"
#include "ecs/base/rotation.h"
#include "ecs/components/all.h"
#include "ecs/components/buoyancy.h"
#include "ecs/hierarchy.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/floating_body.h"
#include "systems/water/water_ripple_field.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace limn::buoyancy_test {

namespace {

constexpr float kStep = 1.0f / 60;
constexpr float kG = 9.81f;

WaterTouch box(const Vec3& half) {
    return {.shape = TouchShape::Box, .half = half};
}
WaterTouch ball(float radius) {
    return {.shape = TouchShape::Ball, .half = Vec3(radius)};
}

/// A body in one water, most often still.
struct Tank {
    WaterSurface surface{.water = {.size = {40, 40}, .depth = 10}};
    WaterTouch touch;
    Floating body;
    Transform place{};
    FloatingState state{.velocity = body.velocity, .spin = body.spin};
    std::vector<Splash> splashes{};

    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            if (const auto splash =
                    step_floating_body({&surface, 1}, touch, body, kStep, state, place)) {
                splashes.push_back(*splash);
            }
        }
    }
    [[nodiscard]] float share_under() const {
        const Displaced displaced = displaced_water(touch, place, surface);
        return displaced.volume / displaced.whole;
    }
    /// Angle between the body's y and the vertical [rad].
    [[nodiscard]] float tilt() const {
        return std::acos(std::clamp((place.rotation * Vec3(0, 1, 0)).y, -1.0f, 1.0f));
    }
    [[nodiscard]] bool is_finite() const {
        return std::isfinite(
            place.position.x + place.position.y + place.position.z + place.rotation.w
            + state.velocity.y + state.spin.y);
    }
};

Quat tilted(float angle) {
    return rotation_about({1, 0, 0}, angle);
}

/// Kinetic energy, and what was put into lifting the body and pushing the water away, by summing
/// over many parts of a box about whose middle the mass is spread.
double energy_of(const Tank& tank) {
    const Vec3 half = tank.touch.half;
    const double volume = 8.0 * static_cast<double>(half.x * half.y * half.z);
    const double mass = static_cast<double>(tank.body.density) * volume;
    const Vec3 h2 = half * half;
    const Vec3 spin = glm::conjugate(tank.place.rotation) * tank.state.spin;
    const Vec3 inertia = Vec3(h2.y + h2.z, h2.z + h2.x, h2.x + h2.y) / 3.0f;
    double energy =
        0.5 * mass
        * static_cast<double>(
            glm::dot(tank.state.velocity, tank.state.velocity) + glm::dot(spin * inertia, spin));
    energy += mass * static_cast<double>(kG * tank.place.position.y);
    constexpr int kParts = 24;
    const double part = volume / (kParts * kParts * kParts);
    for (int x = 0; x < kParts; ++x) {
        for (int y = 0; y < kParts; ++y) {
            for (int z = 0; z < kParts; ++z) {
                const Vec3 own = ((Vec3(x, y, z) + 0.5f) * (2.0f / kParts) - 1.0f) * half;
                const Vec3 at = tank.place.position + tank.place.rotation * own;
                energy += 1000.0 * part * static_cast<double>(kG * std::max(-at.y, 0.0f));
            }
        }
    }
    return energy;
}

/// A pool in a world, with ripples, and bodies that fall into it.
struct Pool {
    explicit Pool(int count, float size = 6) {
        schedule = make_world_schedule();
        water = world.create(
            Transform{.position = {1, 2, 3}}, Water{.size = {size, size}, .depth = 2},
            WaterRipples{.cell = 0.1f},
            WaterWaves{.waves = {{.amplitude = 0.03f, .length = 2.5f, .sharpness = 1}}});
        std::mt19937 random(4);
        std::uniform_real_distribution<float> spread(-0.4f, 0.4f);
        for (int i = 0; i < count; ++i) {
            const Vec3 at =
                Vec3(1, 2, 3)
                + Vec3(spread(random) * size, 0.8f + spread(random), spread(random) * size);
            bodies.push_back(world.create(
                Transform{.position = at, .rotation = tilted(spread(random))},
                i % 2 == 0 ? box({0.2f, 0.1f, 0.15f}) : ball(0.12f),
                Floating{.density = 300.0f + 100.0f * static_cast<float>(i % 10)}));
        }
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    World world;
    Schedule schedule;
    Entity water;
    std::vector<Entity> bodies;
};

}  // namespace

TEST_CASE("buoyancy: a body floats where the water it displaces weighs as much as it does") {
    for (const float density : {60.0f, 250.0f, 500.0f, 900.0f}) {
        Tank tank{.touch = box({0.5f, 0.2f, 0.4f}), .body = {.density = density}};
        tank.place.position = {0, 0.1f, 0};
        tank.run(60 * 60);
        CAPTURE(density);
        CHECK(std::abs(tank.share_under() / (density / 1000) - 1) < 1e-3f);
        const float draft = 0.2f - tank.place.position.y;
        CHECK(std::abs(draft / (0.4f * density / 1000) - 1) < 0.01f);
        CHECK(glm::length(tank.state.velocity) < 1e-3f);
    }
}

TEST_CASE("buoyancy: a ball half as dense as water floats half under") {
    Tank tank{.touch = ball(0.3f), .body = {.density = 500}};
    tank.place.position.y = 0.5f;
    tank.run(60 * 60);
    CHECK(std::abs(tank.place.position.y) < 0.003f);
    tank.body.density = 200;
    tank.run(60 * 60);
    CHECK(std::abs(tank.share_under() / 0.2f - 1) < 1e-3f);
    // pi h^2 (3 r - h) / 3 of a fifth of the ball: h = 0.2871 * 2 r.
    CHECK(std::abs((0.3f - tank.place.position.y) / (0.2871f * 0.6f) - 1) < 0.005f);
}

TEST_CASE("buoyancy: what a body displaces is what is below the surface") {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    const WaterSurface still;
    for (int i = 0; i < 60; ++i) {
        const Vec3 half = {0.6f, 0.3f, 0.4f};
        const Transform place = {
            .position = {1, 0.15f * normal(random), 2},
            .rotation = glm::normalize(
                Quat(normal(random), normal(random), normal(random), normal(random)))};
        const Displaced displaced = displaced_water(box(half), place, still);
        constexpr int kParts = 30;
        Vec3 center(0);
        int under = 0;
        for (int part = 0; part < kParts * kParts * kParts; ++part) {
            const Vec3 cell(part % kParts, part / kParts % kParts, part / (kParts * kParts));
            const Vec3 own = ((cell + 0.5f) * (2.0f / kParts) - 1.0f) * half;
            const Vec3 at = place.position + place.rotation * own;
            under += at.y < 0 ? 1 : 0;
            center += at.y < 0 ? at : Vec3(0);
        }
        const float share = static_cast<float>(under) / (kParts * kParts * kParts);
        CHECK(std::abs(displaced.volume / displaced.whole - share) < 0.02f);
        if (share > 0.1f) {
            CHECK(glm::distance(displaced.center, center / static_cast<float>(under)) < 0.03f);
        }
    }
    // Upright and tilted a little, it is exact.
    const Transform even = {.position = {0, 0.1f, 0}, .rotation = tilted(0.2f)};
    const Displaced displaced = displaced_water(box({0.6f, 0.3f, 0.4f}), even, still);
    CHECK(std::abs(displaced.volume / (1.2 * 0.8 * (0.3 - 0.1 / std::cos(0.2))) - 1) < 1e-5f);
    CHECK(displaced.whole == test::near(1.2 * 0.8 * 0.6));
}

TEST_CASE("buoyancy: a box bobs with the period of its draft") {
    for (const float density : {200.0f, 500.0f, 800.0f}) {
        Tank tank{
            .touch = box({0.5f, 0.4f, 0.5f}),
            .body = {.density = density, .drag = {0, 0, 0}, .damping = 0}};
        const float draft = 0.8f * density / 1000;
        const float rest = 0.4f - draft;
        tank.place.position.y = rest + 0.05f;
        int crossings = 0;
        int first = 0;
        int last = 0;
        bool above = true;
        for (int i = 1; i < 60 * 40; ++i) {
            tank.run(1);
            if ((tank.place.position.y > rest) != above) {
                above = !above;
                first = crossings == 0 ? i : first;
                last = i;
                ++crossings;
            }
            CHECK(std::abs(tank.place.position.y - rest) < 0.052f);
        }
        const float period =
            2 * kStep * static_cast<float>(last - first) / static_cast<float>(crossings - 1);
        CHECK(std::abs(period / (2 * kPi * std::sqrt(draft / kG)) - 1) < 0.02f);
    }
}

TEST_CASE("buoyancy: a box rights itself if its metacenter is above its center of mass") {
    // GM = b^2 / (12 T) + T / 2 - h / 2 with the draft T = h density / 1000; the box may also fall
    // about its other axis, which is longer.
    for (const float density : {300.0f, 500.0f, 800.0f}) {
        for (const float height : {0.4f, 0.7f, 0.76f, 0.95f, 1.3f}) {
            const float draft = height * density / 1000;
            const float metacenter = 1 / (12 * draft) + draft / 2 - height / 2;
            if (std::abs(metacenter) < 0.015f) {
                continue;
            }
            Tank tank{.touch = box({1.0f, 0.5f * height, 0.5f}), .body = {.density = density}};
            tank.place.position.y = 0.5f * height - draft;
            tank.place.rotation = tilted(0.06f);
            tank.run(60 * 40);
            CAPTURE(density);
            CAPTURE(height);
            if (metacenter > 0) {
                CHECK(tank.tilt() < 0.02f);
            } else {
                CHECK(tank.tilt() > 0.2f);
            }
        }
    }
}

TEST_CASE("buoyancy: a box rolls with the period of its metacentric height") {
    // I = m (b^2 + h^2) / 12, righted by m g GM for each radian.
    const float beam = 1;
    const float height = 0.4f;
    const float draft = height / 2;
    const float metacenter = beam * beam / (12 * draft) + draft / 2 - height / 2;
    Tank tank{
        .touch = box({1.0f, 0.5f * height, 0.5f * beam}),
        .body = {.density = 500, .drag = {0, 0, 0}, .damping = 0}};
    tank.place.rotation = tilted(0.03f);
    int crossings = 0;
    int first = 0;
    int last = 0;
    for (int i = 1; i < 60 * 40; ++i) {
        const float before = (tank.place.rotation * Vec3(0, 1, 0)).z;
        tank.run(1);
        if ((before > 0) != ((tank.place.rotation * Vec3(0, 1, 0)).z > 0)) {
            first = crossings == 0 ? i : first;
            last = i;
            ++crossings;
        }
        CHECK(tank.tilt() < 0.032f);
    }
    const float period =
        2 * kStep * static_cast<float>(last - first) / static_cast<float>(crossings - 1);
    const float inertia = (beam * beam + height * height) / 12;
    CHECK(std::abs(period / (2 * kPi * std::sqrt(inertia / (kG * metacenter))) - 1) < 0.02f);
}

TEST_CASE("buoyancy: a heavy keel turns a boat up again from upside down") {
    Tank tank{
        .touch = box({0.4f, 0.5f, 1.2f}),
        .body = {.density = 400, .center_of_mass = {0, -0.35f, 0}}};
    tank.place.rotation = rotation_about({0, 0, 1}, 3.0f);
    tank.run(60 * 40);
    CHECK(tank.tilt() < 0.02f);
    CHECK(std::abs(tank.share_under() / 0.4f - 1) < 1e-3f);
}

TEST_CASE("buoyancy: without resistance energy stays, with it it goes") {
    for (const bool resists : {false, true}) {
        Tank tank{.touch = box({0.6f, 0.3f, 0.5f}), .body = {.density = 600}};
        if (!resists) {
            tank.body.drag = {0, 0, 0};
            tank.body.damping = 0;
        }
        tank.place.position.y = 0.1f;
        tank.place.rotation = tilted(0.25f);
        // Of this least energy there is, floating at rest; the rest can move it.
        Tank calm = tank;
        calm.state.spin = {0, 0, 0};
        calm.place = {.position = {0, 0.3f - 0.36f, 0}};
        const double least = energy_of(calm);
        const double start = energy_of(tank) - least;
        REQUIRE(start > 10.0);
        double before = start;
        double most_at_first = 0;
        double most_at_last = 0;
        double least_of_all = start;
        for (int second = 0; second < 60; ++second) {
            tank.run(60);
            const double now = energy_of(tank) - least;
            if (resists) {
                CAPTURE(second);
                CHECK(now < before + 4e-3 * start);  // its sum is as coarse
            }
            before = now;
            least_of_all = std::min(least_of_all, now);
            double& most = second < 20 ? most_at_first : most_at_last;
            most = std::max(most, now);
        }
        CHECK(most_at_last < 1.02 * most_at_first);
        CHECK(most_at_first < 1.06 * start);
        CHECK((least_of_all > 0.9 * start) == !resists);
        CHECK((before < 0.01 * start) == resists);
    }
}

TEST_CASE("buoyancy: what is denser than water sinks and lies on the bottom") {
    Tank stone{.touch = box({0.2f, 0.1f, 0.3f}), .body = {.density = 2500}};
    stone.place = {.position = {0, 1, 0}, .rotation = rotation_about({1, 2, 3}, 0.7f)};
    stone.run(60 * 20);
    CHECK(glm::length(stone.state.velocity) < 0.02f);
    // On its broadest face.
    CHECK(std::abs(stone.place.position.y / -9.9f - 1) < 1e-3f);
    Tank marble{.touch = ball(0.05f), .body = {.density = 2500}};
    marble.place.position = {1, -1, 0};
    marble.run(60 * 30);
    CHECK(std::abs(marble.place.position.y / -9.95f - 1) < 1e-4f);
    // Deep water has no bottom.
    marble.surface.water.depth = 0;
    marble.run(60 * 10);
    CHECK(marble.place.position.y < -12);
}

TEST_CASE("buoyancy: what sinks falls no faster than its resistance lets it") {
    Tank stone{.touch = ball(0.1f), .body = {.density = 2500, .damping = 0}};
    stone.surface.water.depth = 0;
    stone.run(60 * 10);
    // (density - 1000) g V = 1/2 1000 c A v^2.
    const float terminal = std::sqrt(1500 * kG * (4.0f / 3 * 0.1f) / (0.5f * 1000));
    CHECK(std::abs(-stone.state.velocity.y / (terminal)-1) < 0.01f);
}

TEST_CASE("buoyancy: through air it falls freely, and splashes as its momentum says") {
    float last = 0;
    for (const float height : {0.1f, 0.25f, 0.5f}) {
        Tank tank{.touch = ball(0.05f), .body = {.density = 300}};
        tank.place.position.y = height + 0.05f;
        const float time = std::sqrt(2 * height / kG);
        const int steps = static_cast<int>(time / kStep) - 1;
        tank.run(steps);
        const float fallen = 0.5f * kG * square(kStep * static_cast<float>(steps));
        CHECK(std::abs(height + 0.05f - tank.place.position.y - fallen) < kG * kStep * time);
        CHECK(tank.splashes.empty());
        tank.run(240);
        REQUIRE(tank.splashes.size() >= 1);
        const RippleImpulse& splash = tank.splashes[0].impulse;
        CHECK(splash.height < last);
        CHECK(splash.radius == test::near(1.5 * 0.05));
        last = splash.height;
    }
    Tank laid{.touch = ball(0.05f), .body = {.density = 300}};
    laid.place.position.y = 0.05f;
    laid.run(240);
    CHECK(laid.splashes.empty());
    Tank quiet{.touch = ball(0.05f), .body = {.density = 300, .splash = 0}};
    quiet.place.position.y = 2;
    quiet.run(240);
    CHECK(quiet.splashes.empty());
}

TEST_CASE("buoyancy: a splash grows with momentum, not beyond half its width") {
    const RippleImpulse slow = splash_of(1, 0.1f, 1);
    const RippleImpulse fast = splash_of(1, 0.1f, 2);
    CHECK(fast.height == test::near(2 * slow.height));
    CHECK(splash_of(2, 0.1f, 1).height == test::near(2 * slow.height));
    CHECK(splash_of(1e6f, 0.1f, 100).height == test::near(-0.5 * 0.15));
    CHECK(slow.height < 0);
}

TEST_CASE("buoyancy: a small body goes the way of the water about it, in circles") {
    WaveTable waves;
    const float amplitude = 0.4f;
    const float length = 12;
    const WaterWaves settings = {
        .waves = {{.amplitude = amplitude, .length = length, .sharpness = 1}}};
    Tank tank{.touch = box({0.3f, 0.1f, 0.3f}), .body = {.density = 500}};
    tank.surface.water = {};
    tank.surface.waves = &waves;
    const float period = 2 * kPi / std::sqrt(kG * 2 * kPi / length);
    const int steps = static_cast<int>(8 * period / kStep);
    float low = 1;
    float high = -1;
    float west = 0;
    float east = 0;
    for (int i = 0; i < steps; ++i) {
        fill_wave_table({}, settings, static_cast<double>(kStep) * i, waves);
        tank.run(1);
        const WaterPoint top =
            sample_water(tank.surface, {tank.place.position.x, tank.place.position.z});
        if (i > steps / 2) {
            CHECK(std::abs(top.position.y - tank.place.position.y) < 0.03f);
            CHECK(glm::dot(tank.place.rotation * Vec3(0, 1, 0), top.normal) > 0.995f);
            low = std::min(low, tank.place.position.y);
            high = std::max(high, tank.place.position.y);
            west = std::min(west, tank.place.position.x);
            east = std::max(east, tank.place.position.x);
        }
    }
    // A little more than the water, by how much slower the wave is than the bobbing: omega^2 =
    // g k against g / draft.
    const float swing = 2 * amplitude / (1 - 2 * kPi / length * 0.1f);
    CHECK(std::abs((high - low) / swing - 1) < 0.01f);
    // It is not carried away: to and fro as much as up and down, and a little drift.
    CHECK(east - west > 1.6f * amplitude);
    CHECK(std::abs(tank.place.position.x) < 0.02f * 8 * length);
}

TEST_CASE("buoyancy: a long hull does not feel short waves") {
    WaveTable waves;
    const WaterWaves settings = {.waves = {{.amplitude = 0.1f, .length = 1.5f}}};
    Tank tank{.touch = box({6, 0.4f, 1}), .body = {.density = 500}};
    tank.surface.water = {};
    tank.surface.waves = &waves;
    for (int i = 0; i < 60 * 20; ++i) {
        fill_wave_table({}, settings, static_cast<double>(kStep) * i, waves);
        tank.run(1);
        CHECK(std::abs(tank.place.position.y) < 0.04f);
        CHECK(tank.tilt() < 0.02f);
    }
}

TEST_CASE("buoyancy: waves move what floats, and leave alone what lies deep below") {
    WaveTable waves;
    const WaterWaves settings = {.waves = {{.amplitude = 0.3f, .length = 8, .sharpness = 1}}};
    Tank stone{.touch = ball(0.1f), .body = {.density = 1000, .damping = 0}};
    stone.surface.water = {};
    stone.surface.waves = &waves;
    stone.place.position.y = -12;
    for (int i = 0; i < 60 * 10; ++i) {
        fill_wave_table({}, settings, static_cast<double>(kStep) * i, waves);
        stone.run(1);
    }
    CHECK(glm::distance(stone.place.position, Vec3(0, -12, 0)) < 0.02f);
}

TEST_CASE("buoyancy: a current of waves is not needed to stop; drag is along the body's own axes") {
    const auto way_after = [](const Vec3& velocity) {
        Tank tank{
            .touch = box({0.3f, 0.2f, 0.8f}),
            .body = {.density = 500, .drag = {8, 1, 0.2f}, .damping = 0, .velocity = velocity}};
        tank.run(60 * 3);
        return glm::length(Vec2(tank.place.position.x, tank.place.position.z));
    };
    CHECK(way_after({0, 0, 2}) > 3 * way_after({2, 0, 0}));
}

TEST_CASE("buoyancy: edges hold back what is to stay") {
    for (const bool stays : {true, false}) {
        Tank tank{
            .touch = box({0.4f, 0.2f, 0.4f}),
            .body = {
                .density = 500,
                .drag = {0, 1, 0},
                .damping = 0,
                .confined = stays,
                .velocity = {9, 0, 5}}};
        tank.surface.frame.along_x = {0.8f, 0.6f};
        tank.surface.water.size = {8, 6};
        tank.run(60 * 10);
        const Vec3 local = tank.surface.frame.local(tank.place.position);
        const bool inside = std::abs(local.x) < 4 && std::abs(local.z) < 3;
        CHECK(inside == stays);
        CHECK((tank.place.position.y < -20) != stays);
    }
}

TEST_CASE("buoyancy: bodies as light as foam and as heavy as lead neither jump nor shake") {
    for (const float density : {1.0f, 5.0f, 20.0f, 11000.0f}) {
        for (const float size : {0.02f, 0.2f, 2.0f}) {
            for (const bool is_ball : {false, true}) {
                Tank tank{
                    .touch = is_ball ? ball(size) : box({size, 0.3f * size, 1.5f * size}),
                    .body = {.density = density}};
                tank.place.position.y = 1.5f * size;
                tank.place.rotation = tilted(0.3f);
                CAPTURE(density);
                CAPTURE(size);
                CAPTURE(is_ball);
                float highest = -100;
                for (int i = 0; i < 60 * 20; ++i) {
                    tank.run(1);
                    highest = std::max(highest, tank.place.position.y);
                }
                CHECK(tank.is_finite());
                CHECK(highest < 1.6f * size);
                CHECK(glm::length(tank.state.velocity) < 0.05f);
                CHECK(glm::length(tank.state.spin) < 0.3f);
            }
        }
    }
}

TEST_CASE("buoyancy: numbers that are none are not spread") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Tank tank{.touch = box({0.2f, 0.2f, 0.2f}), .body = {.velocity = {kNan, 0, 0}}};
    tank.state.spin = {0, kInfinity, 0};
    tank.run(60);
    CHECK(tank.is_finite());
    for (const float density : {0.0f, -5.0f, kNan, kInfinity}) {
        Tank odd{.touch = ball(0.2f), .body = {.density = density}};
        odd.run(60);
        CHECK(odd.is_finite());
    }
    for (const Vec3& half : {Vec3(0), Vec3(kNan), Vec3(kInfinity), Vec3(1, 0, 1)}) {
        Tank odd{.touch = box(half), .body = {}};
        odd.run(60);
        CHECK(odd.is_finite());
    }
    Tank flat{.touch = box({1, 1, 1}), .body = {}};
    flat.place.scale = {1, 0, 1};
    flat.run(60);
    CHECK(flat.is_finite());
    Tank lost{.touch = box({1, 1, 1}), .body = {}};
    lost.place.position.x = kNan;
    lost.run(60);
    CHECK(lost.state.velocity == Vec3(0));
    Tank wild{.touch = box({1, 1, 1}), .body = {.drag = {kNan, -3, 0}, .damping = -9}};
    wild.run(60);
    CHECK(std::isfinite(wild.state.velocity.y));
    // Without any water it falls, but not for ever.
    FloatingState state;
    Transform place{};
    for (int i = 0; i < 60 * 300; ++i) {
        CHECK(!step_floating_body({}, ball(1), {}, kStep, state, place));
    }
    CHECK(std::isfinite(place.position.y));
    CHECK(place.position.y > -1.1e4f);
}

TEST_CASE("buoyancy: a world's bodies fall in, make rings and come to rest afloat") {
    Pool pool(6);
    pool.run(8);
    const RippleState& state = pool.world.get<RippleState>(pool.water);
    const auto reach = [&] {
        float most = 0;
        for (const float h : state.height) {
            most = std::max(most, std::abs(h));
        }
        return most;
    };
    CHECK(reach() == 0);
    pool.run(40);
    CHECK(reach() > 0.01f);
    pool.run(60 * 30);
    for (std::size_t i = 0; i < pool.bodies.size(); ++i) {
        const Floating& body = pool.world.get<Floating>(pool.bodies[i]);
        const float submerged = pool.world.get<FloatingState>(pool.bodies[i]).submerged;
        CHECK(std::abs(submerged / (body.density / 1000) - 1) < 0.15f);
    }
}

TEST_CASE("buoyancy: what hangs on something else does not float") {
    World world;
    Schedule schedule = make_world_schedule();
    world.create(Transform{}, Water{});
    const Entity parent = world.create(Transform{});
    const Entity child =
        world.create(Transform{.position = {0, 3, 0}}, ball(0.2f), Floating{}, Parent{parent});
    for (int i = 0; i < 30; ++i) {
        step_world(world, schedule);
    }
    CHECK(world.get<Transform>(child).position == Vec3(0, 3, 0));
}

TEST_CASE("buoyancy: a minute is the same to the bit on any number of threads") {
    const int threads = thread_count();
    std::vector<Vec3> first;
    for (const int count : {1, 2, 4}) {
        set_thread_count(count);
        Pool pool(24);
        pool.run(60 * 4);
        std::vector<Vec3> places;
        for (const Entity body : pool.bodies) {
            places.push_back(pool.world.get<Transform>(body).position);
        }
        if (first.empty()) {
            first = places;
        }
        CHECK(places == first);
    }
    set_thread_count(threads);
}

TEST_CASE("buoyancy: a snapshot goes on as the world does") {
    register_all_components();
    Pool pool(8);
    pool.run(90);
    const Result<std::vector<std::byte>> saved = save_snapshot(pool.world);
    REQUIRE(saved.ok());
    pool.run(120);
    World again;
    REQUIRE(restore_snapshot(again, saved.value()).ok());
    Schedule schedule = make_world_schedule();
    for (int i = 0; i < 120; ++i) {
        step_world(again, schedule);
    }
    for (const Entity body : pool.bodies) {
        CHECK(again.get<Transform>(body).position == pool.world.get<Transform>(body).position);
        CHECK(again.get<FloatingState>(body).spin == pool.world.get<FloatingState>(body).spin);
    }
}

}  // namespace limn::buoyancy_test
