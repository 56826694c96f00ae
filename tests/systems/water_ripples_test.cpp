#include "ecs/base/jobs.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_kernels.h"
#include "tests/near.h"
#include "tests/systems/water_ripple_pool.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::water_ripples_test {

using namespace test;

namespace {

struct Pond {
    explicit Pond(const WaterRipples& ripples = {}, const Water& water = pool(4, 3)) {
        schedule = make_world_schedule();
        entity = world.create(Transform{}, water, ripples);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    [[nodiscard]] const RippleState& state() const { return world.get<RippleState>(entity); }
    World world;
    Schedule schedule;
    Entity entity;
};

}  // namespace

TEST_CASE("water ripples: the grid covers the water, and stays within its limit") {
    const RippleState state = make_ripples(pool(4, 3), {.cell = 0.07f}, kStep);
    CHECK(state.cells == IVec2(58, 43));
    CHECK(state.size().x >= 4);
    CHECK(state.stride % 16 == 0);
    const RippleState vast = make_ripples(pool(5000, 4000), {.cell = 0.01f}, kStep);
    CHECK(vast.cells.x * vast.cells.y <= kMaxRippleCells);
    CHECK(vast.size().x >= 5000);
    CHECK(vast.size().y >= 4000);
    // Unbounded water ripples in its window; without one, or without size, nowhere.
    CHECK(make_ripples(pool(0, 0), {.window = {2, 2}}, kStep).cells == IVec2(40, 40));
    for (const float none : {0.0f, -1.0f, std::numeric_limits<float>::infinity()}) {
        RippleState empty = make_ripples(pool(none, 3), {}, kStep);
        CHECK(empty.cells == IVec2(0, 0));
        push_ripples(empty, {});
        run(empty, {}, 2);
        CHECK(sample_ripples(empty, {0, 0}).height == 0);
    }
}

TEST_CASE("water ripples: SIMD and scalar code are bit-identical") {
    for (const std::size_t width : {1u, 7u, 16u, 61u, 128u}) {
        std::vector<float> rows[3];
        std::vector<float> keep(width);
        for (int r = 0; r < 3; ++r) {
            for (std::size_t x = 0; x < width + 2; ++x) {
                rows[r].push_back(std::sin(static_cast<float>(x) * 1.7f + static_cast<float>(r)));
            }
        }
        std::vector<float> vectors(width);
        for (std::size_t x = 0; x < width; ++x) {
            vectors[x] = std::cos(static_cast<float>(x));
            keep[x] = 0.9f + 0.001f * static_cast<float>(x);
        }
        std::vector<float> plain = vectors;
        const RippleRows three = {rows[0].data() + 1, rows[1].data() + 1, rows[2].data() + 1};
        step_ripple_row(three, vectors, keep.data(), 0.97f, 0.4f);
        step_ripple_row_scalar(three, plain, keep.data(), 0.97f, 0.4f);
        CHECK(vectors == plain);
    }
}

TEST_CASE("water ripples: impulses conserve volume, also in corners") {
    RippleState state = make_ripples(pool(4, 3), {}, kStep);
    for (const Vec2 at : {Vec2(0, 0), Vec2(1.97f, -1.47f), Vec2(0.013f, 1.5f)}) {
        push_ripples(state, {.center = at, .radius = 0.4f, .height = -0.1f});
        CHECK(std::abs(ripple_volume(state)) < 1e-7);
    }
    CHECK(sample_ripples(state, {0, 0}).height == test::near(-0.1).epsilon(0.05).scale(0));
    CHECK(max_height(state) < 0.2f);
}

TEST_CASE(
    "water ripples: a step conserves volume to a millionth of what moves"
    * technique("water.ripple-grid")) {
    RippleState state = make_ripples(pool(4, 3), {}, kStep);
    push_ripples(state, {.center = {0.7f, -0.4f}, .radius = 0.5f, .height = 0.2f});
    double moved = 0;
    for (const float h : state.height) {
        moved += static_cast<double>(std::abs(h) * state.cell * state.cell);
    }
    for (int i = 0; i < 600; ++i) {
        const double before = ripple_volume(state);
        run(state, {}, 1);
        CHECK(std::abs(ripple_volume(state) - before) < 1e-6 * moved);
    }
    CHECK(std::abs(ripple_volume(state)) < 1e-5 * moved);
}

TEST_CASE(
    "water ripples: a standing wave has the period given by its length and speed"
    * technique("water.ripple-grid")) {
    // Half a wave between the walls: period 2 L / c.
    const WaterRipples ripples = {.cell = 0.05f, .speed = 1.5f, .damping = 0};
    RippleState state = make_ripples(pool(3, 0.5f), ripples, kStep);
    fill_standing_wave(state, 0.1f);
    const int half_period = 120;  // steps, at 3 m and 1.5 m/s
    run(state, ripples, half_period);
    CHECK(sample_ripples(state, {-1.4f, 0}).height == test::near(-0.0994).epsilon(0.01).scale(0));
    run(state, ripples, half_period);
    CHECK(sample_ripples(state, {-1.4f, 0}).height == test::near(0.0994).epsilon(0.01).scale(0));
    // A quarter later it is level, and moves fastest: A w.
    run(state, ripples, half_period / 2);
    const RipplePoint level = sample_ripples(state, {-1.4f, 0});
    CHECK(std::abs(level.height) < 0.004f);
    CHECK(level.velocity == test::near(-0.0994 * kPi / 2).epsilon(0.02).scale(0));
}

TEST_CASE("water ripples: they decay by their damping, and oscillate slightly slower") {
    const WaterRipples ripples = {.cell = 0.05f, .speed = 1.5f, .damping = 0.5f};
    const float start = 0.1f * std::cos(kPi / 120);  // at the center of the outermost cell
    for (const int steps : {60, 120, 240}) {
        RippleState state = make_ripples(pool(3, 0.5f), ripples, kStep);
        fill_standing_wave(state, 0.1f);
        run(state, ripples, steps);
        const float time = (static_cast<float>(steps) + 0.5f) / 60;  // at rest half a step ago
        const float omega = std::sqrt(square(kPi / 2) - 0.25f);
        const float swing = std::cos(omega * time) + 0.5f / omega * std::sin(omega * time);
        const float expected = start * std::exp(-0.5f * time) * swing;
        CHECK(
            sample_ripples(state, {-1.5f, 0}).height
            == test::near(expected).epsilon(0.02).scale(0));
    }
}

TEST_CASE(
    "water ripples: rings are round, and run at their speed" * technique("water.ripple-grid")) {
    const WaterRipples ripples = {.cell = 0.04f, .speed = 1, .damping = 0};
    RippleState state = make_ripples(pool(6, 6), ripples, kStep);
    // Of odd size: the center of a cell.
    state = make_ripples(pool(6.04f, 6.04f), ripples, kStep);
    push_ripples(state, {.center = {0, 0}, .radius = 0.6f, .height = 0.1f});
    run(state, ripples, 120);  // 2 s: the ring is 2 m out
    float crest = 0;
    float crest_at = 0;
    float spread = 0;
    for (int i = 30; i < 70; ++i) {
        const float r = 0.04f * static_cast<float>(i);
        const float along = sample_ripples(state, {r, 0}).height;
        const float across = sample_ripples(state, {0, r}).height;
        const float aslant = sample_ripples(state, Vec2(r) / std::sqrt(2.0f)).height;
        CHECK(along == test::near(across).epsilon(1e-4).scale(0));
        spread = std::max(spread, std::abs(along - aslant));
        if (std::abs(along) > crest) {
            crest = std::abs(along);
            crest_at = r;
        }
    }
    CHECK(crest_at == test::near(2.0).epsilon(0.1).scale(0));
    CHECK(spread < 0.05f * crest);
}

TEST_CASE(
    "water ripples: reflecting borders reflect waves, open ones absorb them"
    * technique("water.ripple-grid")) {
    float left[2] = {};
    for (const RippleBorder border : {RippleBorder::Reflecting, RippleBorder::Absorbing}) {
        const WaterRipples ripples = {.speed = 1.5f, .damping = 0, .border = border};
        RippleState state = make_ripples(pool(4, 4), ripples, kStep);
        push_ripples(state, {.center = {0.5f, 0.3f}, .radius = 0.6f, .height = -0.1f});
        run(state, ripples, 300);  // 5 s: the ring has long met every border
        left[static_cast<int>(border)] = max_height(state);
    }
    CHECK(left[0] > 0.01f);
    CHECK(left[1] < 0.05f * left[0]);
}

TEST_CASE("water ripples: open borders reflect less than a twentieth of a crest") {
    const WaterRipples ripples = {
        .cell = 0.05f, .speed = 1.5f, .damping = 0, .border = RippleBorder::Absorbing};
    RippleState state = make_ripples(pool(8, 8), ripples, kStep);
    push_ripples(state, {.radius = 1, .height = 0.1f});
    run(state, ripples, 130);  // 3.3 m: before it is at the borders
    const float crest = max_height(state);
    run(state, ripples, 170);  // beyond the corners
    CHECK(crest > 0.005f);
    CHECK(max_height(state) < 0.04f * crest);
}

TEST_CASE("water ripples: a stone on the ground raises the water by its volume over the area") {
    Pond pond({.cell = 0.05f, .damping = 1});
    pond.world.create(Transform{.position = {0.5f, -1, 0.2f}}, WaterTouch{.half = Vec3(0.3f)});
    pond.run(1200);
    const double volume = 4.0 / 3.0 * 3.14159265 * 0.027;
    CHECK(ripple_volume(pond.state()) == test::near(volume).epsilon(1e-4).scale(0));
    const float level = static_cast<float>(volume / 12);
    CHECK(
        sample_ripples(pond.state(), {-1.5f, -1}).height
        == test::near(level).epsilon(0.1).scale(0));
}

TEST_CASE("water ripples: a body that leaves the water, or is destroyed, lowers the level") {
    for (const bool ends : {false, true}) {
        Pond pond({.damping = 1});
        const Entity stone = pond.world.create(
            Transform{.position = {0, -0.1f, 0}},
            WaterTouch{.shape = TouchShape::Box, .half = {0.3f, 0.2f, 0.4f}});
        pond.run(10);
        // Three quarters of it are under water at rest, and as much more as it has raised that.
        const double under = 0.48 * 0.3 / (1 - 0.48 / 12);
        CHECK(ripple_volume(pond.state()) == test::near(under).epsilon(1e-4).scale(0));
        if (ends) {
            pond.world.destroy(stone);
        } else {
            pond.world.get<Transform>(stone).position.y = 0.5f;
        }
        pond.run(2);
        CHECK(std::abs(ripple_volume(pond.state())) < 1e-5);
        CHECK(pond.state().body.empty());
        CHECK(max_height(pond.state()) > 0.01f);
    }
}

TEST_CASE("water ripples: a body slower than its waves carries a trough, a faster one a crest") {
    // h = U^2 / (U^2 - c^2) of what it pushes up, in one dimension (Lamb 1932, 175).
    for (const bool quick : {false, true}) {
        const float speed = quick ? 2.4f : 0.8f;
        Pond pond({.speed = quick ? 1.2f : 2.4f, .damping = 0}, pool(12, 6));
        const Entity boat =
            pond.world.create(Transform{.position = {-2, 0, 0}}, WaterTouch{.half = Vec3(0.3f)});
        for (int i = 0; i < 90; ++i) {
            pond.world.get<Transform>(boat).position.x += speed / 60;
            pond.run(1);
        }
        const float x = pond.world.get<Transform>(boat).position.x;
        const auto level = static_cast<float>(pond.state().level);
        const float height = sample_ripples(pond.state(), {x, 0}).height - level;
        CHECK((quick ? height : -height) > 0.005f);
        // What runs ahead is none of the quick one's.
        CHECK((std::abs(sample_ripples(pond.state(), {x + 1, 0}).height) < 1e-5f) == quick);
    }
}

TEST_CASE("water ripples: bodies are transformed by the water's rotation and position") {
    Pond pond({}, pool(4, 2));
    pond.world.get<Transform>(pond.entity) = {
        .position = {10, 5, -3}, .rotation = glm::angleAxis(radians(90), Vec3(0, 1, 0))};
    // The water's +x is the world's -z now.
    pond.world.create(Transform{.position = {10.2f, 4.5f, -4.5f}}, WaterTouch{.half = Vec3(0.2f)});
    pond.run(1);
    const RippleState& state = pond.state();
    CHECK(state.level > 0);
    const float* const most = &*std::max_element(state.body.begin(), state.body.end());
    const auto index = static_cast<std::size_t>(most - state.body.data());
    const auto stride = static_cast<std::size_t>(state.stride);
    const Vec2 at =
        state.cell * (Vec2(index % stride, index / stride) - 0.5f - 0.5f * Vec2(state.cells));
    CHECK(at.x == test::near(1.5).epsilon(0.04).scale(0));
    CHECK(at.y == test::near(0.2).epsilon(0.2).scale(0));
}

TEST_CASE("water ripples: rain falls at its rate, the same for any number of threads") {
    std::vector<float> first;
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        Pond pond({.rain = 20, .rain_height = 0.02f});
        pond.run(120);
        CHECK(max_height(pond.state()) > 0.002f);
        CHECK(std::abs(ripple_volume(pond.state())) < 1e-5);
        if (first.empty()) {
            first = pond.state().height;
        }
        CHECK(pond.state().height == first);
    }
    set_thread_count(2);
}

TEST_CASE("water ripples: drops match the rain rate, are uniform, and differ per pool") {
    // Waves that stand still keep each drop's mark.
    World world;
    Schedule schedule = make_world_schedule();
    const WaterRipples ripples = {.speed = 0, .damping = 0, .rain = 8, .rain_height = 0.01f};
    const Entity first = world.create(Transform{}, pool(6, 4), ripples);
    const Entity second = world.create(Transform{}, pool(6, 4), ripples);
    for (int i = 0; i < 120; ++i) {
        step_world(world, schedule);
    }
    const RippleState& state = world.get<RippleState>(first);
    RippleState drop = make_ripples(pool(6, 4), ripples, kStep);
    push_ripples(drop, {.radius = 3 * drop.cell, .height = -0.01f});
    double marks = 0;
    double mark = 0;
    Vec2 spread(0);
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const float square_height = square(state.height[state.at(x, z)]);
            const Vec2 fraction = (Vec2(x, z) + 0.5f) / Vec2(state.cells) - 0.5f;
            marks += static_cast<double>(square_height);
            mark += static_cast<double>(square(drop.height[drop.at(x, z)]));
            spread += square_height * fraction * fraction;
        }
    }
    CHECK(marks / mark == test::near(8 * 24 * 2).epsilon(0.15).scale(0));
    for (int axis = 0; axis < 2; ++axis) {
        CHECK(
            static_cast<double>(spread[axis]) / marks
            == test::near(1.0 / 12).epsilon(0.15).scale(0));
    }
    CHECK(state.height != world.get<RippleState>(second).height);
}

TEST_CASE("water ripples: another size or cell size gives a new grid at rest") {
    Pond pond({}, pool(2, 6));
    pond.run(1);
    push_ripples(pond.world.get<RippleState>(pond.entity), {.center = {0, 2.5f}});
    pond.run(1);
    // It has two ends, one of which is nearer.
    CHECK(max_height(pond.state()) > 0.01f);
    push_ripples(pond.world.get<RippleState>(pond.entity), {.center = {2.5f, 0}, .height = 9});
    CHECK(max_height(pond.state()) < 1);
    CHECK(sample_ripples(pond.state(), {0, 2.5f}).height != 0);
    CHECK(sample_ripples(pond.state(), {2.5f, 0}).height == 0);
    const IVec2 cells = pond.state().cells;
    pond.world.get<WaterRipples>(pond.entity).cell = 0.1f;
    pond.run(1);
    CHECK(pond.state().cells == cells / 2);
    CHECK(max_height(pond.state()) == 0);
    pond.world.get<Water>(pond.entity).size.x = 4;
    pond.run(1);
    CHECK(pond.state().cells == IVec2(cells.x, cells.y / 2));
    pond.world.get<Water>(pond.entity).size.x = 0;
    pond.run(1);
    CHECK(pond.state().cells == IVec2(0));
}

TEST_CASE("water ripples: height, slope and velocity can be sampled anywhere") {
    RippleState state = make_ripples(pool(4, 3), {}, kStep);
    const auto field = [](const Vec2& p) { return 0.02f * p.x - 0.05f * p.y + 0.01f; };
    for (int z = 0; z < state.cells.y; ++z) {
        for (int x = 0; x < state.cells.x; ++x) {
            const Vec2 p = state.cell * (Vec2(x, z) + 0.5f - 0.5f * Vec2(state.cells));
            state.height[state.at(x, z)] = field(p);
            state.previous[state.at(x, z)] = field(p) - 0.3f * kStep;
        }
    }
    for (const Vec2 p : {Vec2(0, 0), Vec2(1.333f, -1.1f), Vec2(-0.777f, 0.123f)}) {
        const RipplePoint found = sample_ripples(state, p);
        CHECK(found.height == test::near(field(p)).epsilon(1e-4).scale(0));
        CHECK(found.velocity == test::near(0.3).epsilon(1e-3).scale(0));
        CHECK(found.slope.x == test::near(0.02).epsilon(1e-3).scale(0));
        CHECK(found.slope.y == test::near(-0.05).epsilon(1e-3).scale(0));
    }
    CHECK(sample_ripples(state, {2.1f, 0}).height == 0);
}

}  // namespace limn::water_ripples_test
