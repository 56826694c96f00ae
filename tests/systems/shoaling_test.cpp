#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/shoaling_system.h"
#include "systems/water/water_dispersion.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::shoaling_test {
namespace {

constexpr ShoalingWaves kTank = {
    .size = {4, 4},
    .points = 129,
    .period = 0.7f,
    .direction = 0,
    .amplitude = 0.02f,
    .depth = 0.5f,
    .shoal_depth = 0.06f,
    .shoal_radius = 1.2f};

/// Distance between crests along x at row `j`, about column `i`: 2 pi over the slope of the phase.
double length_at(const ShoalingState& state, int i, int j) {
    const auto phase = [&](int x) {
        return static_cast<double>(
            state.phase[static_cast<std::size_t>(j) * kTank.points + static_cast<std::size_t>(x)]);
    };
    const double cell = 4.0 / (kTank.points - 1);
    return 2 * M_PI * 2 * cell / (phase(i + 1) - phase(i - 1));
}

}  // namespace

TEST_CASE(
    "shoaling: wavelength follows depth, shorter over the shoal, with the same period"
    * technique("water.shallow-refraction")) {
    World world;
    const Entity tank = world.create(Transform{}, kTank);
    Schedule schedule = make_world_schedule();
    start_world(world);
    const ShoalingState& state = std::as_const(world).get<ShoalingState>(tank);
    const double omega = 2 * M_PI / 0.7;
    CHECK(state.frequency == test::near(omega));
    const double deep = 2 * M_PI / wave_number(omega, 0.5);
    const double shallow = 2 * M_PI / wave_number(omega, static_cast<double>(0.06f));
    CHECK(length_at(state, 8, 6) == test::near(deep).epsilon(0.02));
    CHECK(length_at(state, 64, 64) == test::near(shallow).epsilon(0.05));
    CHECK(shallow < 0.8 * deep);
    // A period later all heights are back.
    const std::vector<float> before = std::as_const(world).get<HeightField>(tank).height;
    world.resource<FrameTime>().step = 0.35f;
    step_world(world, schedule);
    const std::vector<float> half = std::as_const(world).get<HeightField>(tank).height;
    step_world(world, schedule);
    const std::vector<float> after = std::as_const(world).get<HeightField>(tank).height;
    for (std::size_t i = 0; i < before.size(); i += 97) {
        CHECK(after[i] == test::near(before[i]).scale(0.02).epsilon(1e-3));
        CHECK(half[i] == test::near(-before[i]).scale(0.02).epsilon(1e-3));
    }
}

TEST_CASE(
    "shoaling: behind the shoal crests bend toward its axis, symmetrically"
    * technique("water.shallow-refraction")) {
    World world;
    const Entity tank = world.create(Transform{}, kTank);
    start_world(world);
    const ShoalingState& state = std::as_const(world).get<ShoalingState>(tank);
    const auto phase = [&](int x, int z) {
        return state.phase[static_cast<std::size_t>(z * 129 + x)];
    };
    // On the axis a wave arrives later than beside it.
    CHECK(phase(110, 64) > phase(110, 20) + 0.5f);
    for (int z = 0; z < 64; z += 7) {
        CHECK(phase(110, 64 - z) == test::near(phase(110, 64 + z)).epsilon(1e-3));
    }
}

TEST_CASE(
    "shoaling: a mesh gets heights and normals of its entity, and is uploaded again"
    * technique("water.noise-surface")) {
    World world;
    MeshData mesh;
    mesh.positions = {{-2, 0, -2}, {2, 0, -2}, {0, 0, 0}, {2, 0, 2}};
    mesh.normals.assign(4, Vec3(0, 1, 0));
    Assets& assets = world.insert_resource(Assets{});
    assets.meshes.push_back(mesh);
    const Entity tank = world.create(Transform{}, kTank, MeshInstance{.mesh = {0}, .material = {}});
    start_world(world);
    const HeightField& field = std::as_const(world).get<HeightField>(tank);
    const MeshData& shaped = world.resource<Assets>().meshes[0];
    CHECK(shaped.version > mesh.version);
    CHECK(shaped.positions[0].y == field.height[0]);
    CHECK(shaped.positions[1].y == field.height[128]);
    CHECK(shaped.positions[2].y == field.height[64 * 129 + 64]);
    CHECK(shaped.positions[3].y == field.height[129 * 129 - 1]);
    CHECK(shaped.normals[2] == field.normal[64 * 129 + 64]);
    CHECK(shaped.bounds.max.y <= 0.02f);
    CHECK(shaped.bounds.min.y >= -0.02f);
}

}  // namespace limn::shoaling_test
