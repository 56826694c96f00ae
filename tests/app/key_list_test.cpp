#include "content/app/panels/emitter_controls.h"
#include "content/app/panels/key_list.h"
#include "ecs/components/all.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/world.h"
#include "systems/particles/emitter_restart.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <set>

namespace limn::key_list_test {
namespace {

/// 200 x 100 pixels from (10, 20); a value of 2 is at the upper edge.
constexpr KeyPlot kPlot{.corner = {10, 20}, .size = {200, 100}, .top = 2, .pick_radius = 8};

std::vector<CurveKey> curve() {
    return {{0, 1}, {0.5f, 2}, {1, 0}};
}

}  // namespace

TEST_CASE("key list: keys are picked within the pick radius, the nearest one first") {
    CHECK(key_position(kPlot, CurveKey{0.5f, 2}) == Vec2(110, 20));
    CHECK(key_position(kPlot, CurveKey{0, 1}) == Vec2(10, 70));
    CHECK(hit_key(kPlot, curve(), {110, 20}) == 1);
    CHECK(hit_key(kPlot, curve(), {110, 28}) == 1);
    CHECK(hit_key(kPlot, curve(), {110, 28.5f}) == -1);
    CHECK(hit_key(kPlot, curve(), {104, 26}) == -1);  // too far by the diagonal
    const std::vector<CurveKey> close = {{0.5f, 1}, {0.53f, 1}};
    CHECK(hit_key(kPlot, close, {112.9f, 70}) == 0);
    CHECK(hit_key(kPlot, close, {113.1f, 70}) == 1);
    // The stops of a gradient are hit at any height.
    const std::vector<ColorKey> stops = {{0.25f, {1, 0, 0}, 1}, {0.75f, {0, 1, 0}, 1}};
    CHECK(hit_key(kPlot, stops, {165, 300}) == 1);
    CHECK(hit_key(kPlot, stops, {110, 20}) == -1);
    CHECK(hit_key(kPlot, std::vector<ColorKey>{}, {110, 20}) == -1);
}

TEST_CASE("key list: a drag moves the selected key, even past others, but not out of the plot") {
    std::vector<CurveKey> keys = curve();
    int selected = -1;
    CHECK_FALSE(edit_keys(kPlot, {.pointer = {12, 69}, .pressed = true}, keys, selected));
    CHECK(selected == 0);
    // A click beside the center of a key does not move it.
    keys[0] = {0, 1};
    CHECK_FALSE(edit_keys(kPlot, {.pointer = {10.5f, 70.5f}, .held = true}, keys, selected));
    CHECK(keys[0].value == 1);
    CHECK(edit_keys(kPlot, {.pointer = {60, 45}, .held = true}, keys, selected));
    CHECK(keys[0].at == test::near(0.25));
    CHECK(keys[0].value == test::near(1.5));
    CHECK(edit_keys(kPlot, {.pointer = {160, 45}, .held = true}, keys, selected));
    CHECK(selected == 1);
    REQUIRE(keys.size() == 3);
    CHECK(keys[0].at == 0.5f);
    CHECK(keys[1].at == test::near(0.75));
    CHECK(edit_keys(kPlot, {.pointer = {900, -50}, .held = true}, keys, selected));
    CHECK(keys[static_cast<std::size_t>(selected)].at == 1);
    CHECK(keys[static_cast<std::size_t>(selected)].value == 2);
    CHECK(edit_keys(kPlot, {.pointer = {-900, 500}, .held = true}, keys, selected));
    CHECK(selected == 0);
    CHECK(keys[0].at == 0);
    CHECK(keys[0].value == 0);
    // Nothing is dragged that was not selected.
    selected = -1;
    CHECK_FALSE(edit_keys(kPlot, {.pointer = {60, 45}, .held = true}, keys, selected));
}

TEST_CASE("key list: a double click adds a key in order, unless there is one, eight at most") {
    std::vector<CurveKey> keys = curve();
    int selected = -1;
    CHECK_FALSE(edit_keys(kPlot, {.pointer = {111, 21}, .double_clicked = true}, keys, selected));
    CHECK(edit_keys(kPlot, {.pointer = {160, 95}, .double_clicked = true}, keys, selected));
    REQUIRE(keys.size() == 4);
    CHECK(selected == 2);
    CHECK(keys[2].at == test::near(0.75));
    CHECK(keys[2].value == test::near(0.5));
    for (int i = 0; i < 10; ++i) {
        const float x = 20.0f + 18.0f * static_cast<float>(i);
        edit_keys(kPlot, {.pointer = {x, 110}, .double_clicked = true}, keys, selected);
    }
    CHECK(keys.size() == kMaxEditedKeys);
    for (std::size_t i = 1; i < keys.size(); ++i) {
        CHECK(keys[i - 1].at <= keys[i].at);
    }
    // A new stop of a gradient has the color that was there, so that nothing changes at first.
    std::vector<ColorKey> stops = {{1, {0, 1, 0}, 1}, {0, {1, 0, 0}, 0.5f}};  // in any order
    CHECK(edit_keys(kPlot, {.pointer = {60, 30}, .double_clicked = true}, stops, selected));
    REQUIRE(stops.size() == 3);
    CHECK(selected == 1);
    CHECK(stops[1].at == test::near(0.25));
    CHECK(stops[1].color.x == test::near(0.75));
    CHECK(stops[1].color.y == test::near(0.25));
    CHECK(stops[1].opacity == test::near(0.625));
    // And the first one is white.
    stops.clear();
    CHECK(edit_keys(kPlot, {.pointer = {60, 30}, .double_clicked = true}, stops, selected));
    CHECK(stops[0].color == Vec3(1));
}

TEST_CASE("key list: a right click removes the key under it, Delete the selected one") {
    std::vector<CurveKey> keys = curve();
    int selected = 0;
    CHECK_FALSE(edit_keys(kPlot, {.pointer = {60, 110}, .right_clicked = true}, keys, selected));
    CHECK(edit_keys(kPlot, {.pointer = {110, 20}, .right_clicked = true}, keys, selected));
    REQUIRE(keys.size() == 2);
    CHECK(keys[1].at == 1);
    CHECK(selected == -1);
    CHECK_FALSE(edit_keys(kPlot, {.removes = true}, keys, selected));
    selected = 1;
    CHECK(edit_keys(kPlot, {.removes = true}, keys, selected));
    REQUIRE(keys.size() == 1);
    CHECK(keys[0].at == 0);
    selected = 5;  // of a longer list
    CHECK_FALSE(edit_keys(kPlot, {.removes = true}, keys, selected));
    CHECK(selected == -1);
}

TEST_CASE("key list: the top of the plot is the next power of two above the values") {
    CHECK(plot_top({}) == 1);
    CHECK(plot_top({{0, 0.3f}}) == 1);
    CHECK(plot_top({{0, 1.01f}, {1, 0}}) == 2);
    CHECK(plot_top({{0, 5}}) == 8);
    CHECK(plot_top({{0, 1000}}) == 1024);
}

TEST_CASE(
    "emitter controls: counts, dropped particles, a restart without particles, and another seed") {
    register_all_components();
    World world;
    ParticleEmitter settings;
    settings.capacity = 50;
    const Entity emitter = world.create(settings);
    CHECK(count_particles(world, emitter).capacity == 50);
    CHECK(count_particles(world, emitter).born == 0);
    ParticlePool pool;
    pool.clock = {.born = 80, .dropped = 5, .time = 3};
    pool.x = {1, 2, 3};
    world.add(emitter, pool);
    const EmitterCounts counts = count_particles(world, emitter);
    CHECK(counts.alive == 3);
    CHECK(counts.born == 80);
    CHECK(counts.dropped == 5);
    CHECK_FALSE(counts.on_gpu);
    CHECK(describe_drops(world).starts_with("5 particles of 1 emitter dropped:"));
    restart_emitter(world, emitter);
    CHECK(describe_drops(world).empty());
    CHECK(count_particles(world, emitter).alive == 0);
    CHECK(count_particles(world, emitter).born == 0);
    CHECK(world.get<const ParticlePool>(emitter).clock.time == 0);

    settings.executor = ParticleExecutor::Gpu;
    const Entity on_gpu = world.create(settings);
    GpuParticles particles;
    particles.clock.born = 30;
    particles.cohorts = {{.first = 18, .born = 1}};
    world.add(on_gpu, particles);
    CHECK(count_particles(world, on_gpu).on_gpu);
    CHECK(count_particles(world, on_gpu).alive == 12);
    restart_emitter(world, on_gpu);
    CHECK(count_particles(world, on_gpu).alive == 0);

    std::set<std::uint32_t> seeds;
    std::uint32_t seed = 0;
    for (int i = 0; i < 1000; ++i) {
        seed = next_seed(seed);
        CHECK(seed != 0);
        seeds.insert(seed);
    }
    CHECK(seeds.size() == 1000);
}

}  // namespace limn::key_list_test
