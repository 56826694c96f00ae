#include "ecs/base/jobs.h"
#include "ecs/components/buoyancy.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_waves.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_system.h"
#include "tests/ecs/allocated_bytes.h"
#include "tests/systems/water_ripple_pool.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

// Ripples of settings that make no sense, of any step, and of many pools.

namespace limn::water_ripple_limits_test {

using namespace test;

TEST_CASE("water ripples: steps of any length, 0, negative or NaN are safe") {
    const float inf = std::numeric_limits<float>::infinity();
    for (const float damping : {0.0f, 0.4f, 100.0f}) {
        for (const float speed : {0.0f, 0.01f, 1.2f, 1000.0f}) {
            const WaterRipples ripples = {.cell = 0.1f, .speed = speed, .damping = damping};
            RippleState state = make_ripples(pool(2, 2), ripples, kStep);
            CAPTURE(speed);
            CAPTURE(damping);
            push_ripples(state, {.radius = 0.5f, .height = -0.1f});
            run(state, ripples, 5);
            for (const float step : {1e-9f, 1e6f, 0.5f, 1e30f, kStep, 1e-30f, 3600.0f}) {
                step_ripples(state, ripples, step);
                step_ripples(state, ripples, step);
                CAPTURE(step);
                CHECK(max_height(state) < 1);
                CHECK(std::isfinite(sample_ripples(state, {0, 0}).velocity));
            }
            const std::vector<float> before = state.height;
            state.impulses.push_back({});
            for (const float step : {0.0f, -1.0f, -inf, inf, std::nanf("")}) {
                step_ripples(state, ripples, step);
            }
            CHECK(state.height == before);
            CHECK(state.impulses.size() == 1);
        }
    }
}

TEST_CASE("water ripples: the motion of waves does not depend on the step length") {
    const WaterRipples ripples = {.cell = 0.05f, .speed = 1.5f, .damping = 0};
    RippleState even = make_ripples(pool(3, 0.5f), ripples, kStep);
    fill_standing_wave(even, 0.1f);
    RippleState uneven = even;
    run(even, ripples, 90);
    for (int i = 0; i < 60; ++i) {
        step_ripples(uneven, ripples, kStep);
        step_ripples(uneven, ripples, 0.5f * kStep);
        step_ripples(uneven, ripples, 1e-9f);  // is none
    }
    for (const float x : {-1.4f, -0.5f, 1.2f}) {
        const RipplePoint a = sample_ripples(even, {x, 0});
        const RipplePoint b = sample_ripples(uneven, {x, 0});
        CHECK(std::abs(a.height - b.height) < 0.002f);
        CHECK(std::abs(a.velocity - b.velocity) < 0.003f);
    }
    // Waves that are too quick go as far in every sub-step, however long it is.
    const WaterRipples quick = {.cell = 0.05f, .speed = 1000, .damping = 0};
    RippleState one = make_ripples(pool(2, 2), quick, kStep);
    push_ripples(one, {.radius = 0.5f, .height = 0.1f});
    RippleState other = one;
    for (int i = 0; i < 8; ++i) {
        step_ripples(one, quick, kStep);
        step_ripples(other, quick, i % 2 == 0 ? kStep : 0.3f);
    }
    for (const Vec2 at : {Vec2(0, 0), Vec2(0.5f, 0.2f), Vec2(-0.8f, 0.9f)}) {
        const float height = sample_ripples(one, at).height;
        CHECK(std::abs(height - sample_ripples(other, at).height) < 1e-4f);
    }
}

TEST_CASE("water ripples: cells of any size, and water of zero or negative depth are safe") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float cell : {0.0f, -1.0f, nan}) {
        CHECK(make_ripples(pool(4, 3), {.cell = cell}, kStep).cells == IVec2(0));
    }
    for (const float cell : {1e-30f, 1e-6f, 1e6f, 1e30f}) {
        const RippleState state = make_ripples(pool(4, 3), {.cell = cell}, kStep);
        CHECK(state.cells.x >= 4);
        CHECK(state.cells.y >= 4);
        CHECK(state.cells.x * state.cells.y <= kMaxRippleCells);
    }
    World world;
    Schedule schedule = make_world_schedule();
    const WaterRipples rain = {.cell = 1e6f, .rain = 50};
    const Entity deep = world.create(
        Transform{}, Water{.size = {4, 3}, .depth = -2}, WaterWaves{.waves = {{}}}, rain);
    const Entity none = world.create(Transform{}, Water{.size = {-4, 0}, .depth = nan}, rain);
    world.create(Transform{.position = {0, -1, 0}}, WaterTouch{}, Floating{});
    for (int i = 0; i < 30; ++i) {
        step_world(world, schedule);
    }
    CHECK(max_height(world.get<RippleState>(deep)) < 10);
    CHECK(world.get<RippleState>(none).cells == IVec2(0));
    for (const WaveLine& line : world.get<WaveTable>(deep).lines) {
        CHECK(std::isfinite(line.frequency));
    }
}

TEST_CASE("water ripples: of a hundred thousand impulses as wide as the pool, most are dropped") {
    RippleState state = make_ripples(pool(10, 10), {}, kStep);
    for (int i = 0; i < 100000; ++i) {
        state.impulses.push_back({.radius = 1e9f, .height = 1e-4f});
    }
    run(state, {}, 1);
    CHECK(state.impulses.empty());
    CHECK(state.dropped > 99000);
    CHECK(state.dropped < 100000);
    CHECK(max_height(state) < 10);
    // As many drops are none too many.
    RippleState rained = make_ripples(pool(10, 10), {}, kStep);
    for (int i = 0; i < 100000; ++i) {
        const float turn = static_cast<float>(i);
        rained.impulses.push_back(
            {.center = 5.0f * Vec2(std::sin(turn), std::cos(1.3f * turn)), .radius = 0.15f});
    }
    run(rained, {}, 1);
    CHECK(rained.dropped == 0);
}

TEST_CASE("water ripples: too fast, too many, too small, or NaN input never gives NaN") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    // A step that no grid can take is taken in pieces; waves that are quicker still are slowed.
    for (const float speed : {0.0f, 40.0f, 1000.0f, nan}) {
        const WaterRipples ripples = {.cell = 0.02f, .speed = speed, .damping = 0};
        RippleState state = make_ripples(pool(2, 2), ripples, kStep);
        push_ripples(state, {.radius = 0.3f, .height = 0.5f});
        run(state, ripples, 300);
        CHECK(max_height(state) < 2);
        CHECK(state.substeps <= kMaxRippleSubsteps);
    }
    const WaterRipples calm;
    RippleState state = make_ripples(pool(2, 2), calm, kStep);
    for (const RippleImpulse& bad :
         {RippleImpulse{.center = {nan, 0}}, RippleImpulse{.radius = nan},
          RippleImpulse{.height = std::numeric_limits<float>::infinity()},
          RippleImpulse{.center = {1e30f, 0}}}) {
        push_ripples(state, bad);
    }
    CHECK(max_height(state) == 0);
    push_ripples(state, {.radius = -1, .height = 0.1f});
    push_ripples(state, {.radius = 1e20f, .height = 0.1f});
    push_ripples(state, {.radius = 0.2f, .height = 1e20f});
    step_ripples(state, calm, nan);
    step_ripples(state, calm, -1);
    run(state, calm, 10);
    CHECK(max_height(state) < 100);
    // A body of no size, or of any, does no harm.
    displace_ripples(
        state, std::vector<WaterBulge>{
                   {.radius = {0, 0}, .volume = 0.1f},
                   {.radius = {nan, 1}, .volume = 1},
                   {.volume = nan}});
    CHECK(std::isfinite(max_height(state)));
    // A hundred thousand impulses in one step.
    for (int i = 0; i < 100000; ++i) {
        const float a = static_cast<float>(i);
        state.impulses.push_back(
            {.center = {std::sin(a), std::cos(1.3f * a)}, .radius = 0.1f, .height = 1e-3f});
    }
    run(state, calm, 2);
    CHECK(state.impulses.empty());
    CHECK(max_height(state) < 1000);
}

TEST_CASE("water ripples: a hundred pools are bit-identical to one, a hundred times") {
    World world;
    Schedule schedule = make_world_schedule();
    std::vector<Entity> pools;
    std::vector<RippleState> alone;
    const WaterRipples ripples = {.cell = 0.1f};
    const RippleImpulse splash = {.center = {0.1f, 0.1f}, .radius = 0.5f, .height = -0.1f};
    for (int i = 0; i < 100; ++i) {
        const float size = 1.5f + 0.03f * static_cast<float>(i);
        const Vec3 position = {
            8.0f * static_cast<float>(i % 10), 0, 15.0f * static_cast<float>(i / 10)};
        pools.push_back(
            world.create(Transform{.position = position}, pool(size, 2 * size), ripples));
        if (i % 3 == 0) {
            world.create(
                Transform{.position = position + Vec3(0.2f, -0.3f, 0)},
                WaterTouch{.half = Vec3(0.2f)});
        }
        if (i % 4 == 0) {
            world.create(
                Transform{.position = position + Vec3(-0.4f, 0, 0.3f)},
                WaterWall{.half = Vec3(0.2f)});
        }
    }
    for (const Entity entity : pools) {
        if (!world.has<RippleState>(entity)) {
            step_world(world, schedule);
        }
    }
    for (std::size_t i = 0; i < pools.size(); ++i) {
        RippleState& state = world.get<RippleState>(pools[i]);
        alone.push_back(state);
        state.impulses.push_back(splash);
        CHECK(state.body.empty() == (i % 3 != 0));
        CHECK(state.walls.size() == (i % 4 == 0 ? 1 : 0));
    }
    for (int i = 0; i < 20; ++i) {
        step_world(world, schedule);
    }
    for (std::size_t i = 0; i < pools.size(); ++i) {
        push_ripples(alone[i], splash);
        const RippleState& state = world.get<RippleState>(pools[i]);
        if (i % 3 != 0) {  // the level of the others is one step behind
            run(alone[i], ripples, 20);
            CHECK(state.height == alone[i].height);
        }
        CHECK(max_height(state) > 0);
    }
}

TEST_CASE("water ripples: stepping allocates no memory, with any number of pools") {
    World world;
    Schedule schedule;
    schedule.add<update_water_ripples>();
    for (int i = 0; i < 100; ++i) {
        const Vec3 position = {6.0f * static_cast<float>(i), 0, 0};
        const float size = 1 + 0.03f * static_cast<float>(i);
        world.create(
            Transform{.position = position}, pool(size, size),
            WaterRipples{.cell = 0.1f, .rain = 5});
        world.create(Transform{.position = position + Vec3(0, -0.3f, 0)}, WaterTouch{});
        world.create(Transform{.position = position + Vec3(0.3f, 0, 0)}, WaterWall{});
    }
    start_world(world);
    set_thread_count(1);
    const auto steps = [&](int count) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    };
    steps(120);  // lists of drops grow to what they need
    const std::size_t few = test::bytes_allocated_by([&] { steps(10); });
    CHECK(few < 2000);
    set_thread_count(2);
}

}  // namespace limn::water_ripple_limits_test
