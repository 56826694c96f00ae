#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/water_query.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_shape.h"
#include "systems/water/water_touch.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace limn::water_touch_test {

namespace {

Affine at(const Vec3& position, const Quat& rotation = Quat(1, 0, 0, 0)) {
    return affine_from(position, rotation, Vec3(1));
}

/// A box of 12 triangles, outward, appended to `mesh`; its vertices follow `joint`.
void add_box(MeshData& mesh, const Vec3& center, const Vec3& half, std::uint16_t joint) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i) {
        const Vec3 sign = {i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
        mesh.positions.push_back(center + sign * half);
        if (mesh.skin.first.empty()) {
            mesh.skin.first.push_back(0);
        }
        mesh.skin.joints.push_back(joint);
        mesh.skin.weights.push_back(1);
        mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    }
    constexpr std::uint32_t kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : kFaces) {
        for (const int corner : {0, 1, 2, 0, 2, 3}) {
            mesh.indices.push_back(first + face[corner]);
        }
    }
}

/// A trunk about the origin and an arm that a second joint moves, 1 m along x.
struct Swimmer {
    Swimmer() {
        add_box(mesh, {0, 0, 0}, {0.2f, 0.5f, 0.2f}, 0);
        add_box(mesh, {1, 0, 0}, {0.5f, 0.1f, 0.1f}, 1);
        skin.joints = {0, 1};
        skin.joint_from_mesh = {Affine{}, at({-0.5f, 0, 0})};
        pose.joints = {Affine{}, at({0.5f, 0, 0})};
    }
    MeshData mesh;
    SkinData skin;
    Pose pose;
};

constexpr float kTrunk = 0.16f;
constexpr float kArm = 0.04f;

/// What all of a swimmer at this height displaces of still water.
float displaced(const Swimmer& swimmer, float height, const Quat& rotation = Quat(1, 0, 0, 0)) {
    const TouchParts parts = make_touch_parts(swimmer.mesh, &swimmer.skin);
    std::vector<TouchingShape> shapes;
    add_touching_shapes(
        {.shape = TouchShape::Mesh}, at({0, height, 0}, rotation), &parts, &swimmer.skin,
        &swimmer.pose, shapes);
    float sum = 0;
    for (const TouchingShape& shape : shapes) {
        sum += bulge_of(shape, {.water = {.size = {9, 9}}}, 0, {9, 9}).volume;
    }
    return sum;
}

}  // namespace

TEST_CASE("water shape: the volume below a level matches the formula of each shape") {
    const Affine raised = at({0.3f, 0.2f, 0});
    const auto below = [&](WallShape shape, const Vec3& half, float height) {
        return volume_below(place_shape(shape, half, {0, 0.1f, 0}, raised, {}), height);
    };
    // A cap of h: pi h^2 (3 r - h) / 3. Middles are at 0.3.
    for (const float h : {0.1f, 0.4f, 0.7f}) {
        const float cap = kPi * h * h * (3 * 0.4f - h) / 3;
        CHECK(below(WallShape::Ball, Vec3(0.4f), -0.1f + h) == test::near(cap));
    }
    CHECK(below(WallShape::Ball, {0.4f, 0.2f, 0.3f}, 9) == test::near(4.18879 * 0.024));
    CHECK(below(WallShape::Box, {0.4f, 0.2f, 0.3f}, 0.2f) == test::near(0.8 * 0.6 * 0.1));
    CHECK(below(WallShape::Cylinder, {0.4f, 0.2f, 0.3f}, 0.2f) == test::near(0.037699));
    CHECK(below(WallShape::Box, Vec3(0.2f), 0.09f) == 0);
    CHECK(below(WallShape::Box, Vec3(0.2f), 9) == test::near(0.064));
}

TEST_CASE("water shape: its extent is that of its farthest point") {
    const Quat turn = glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, 0.5f)));
    const Vec3 half = {0.4f, 0.2f, 0.7f};
    for (const WallShape shape : {WallShape::Box, WallShape::Cylinder, WallShape::Ball}) {
        const WaterShape placed = place_shape(shape, half, Vec3(0), at({1, 2, 3}, turn), {});
        Vec3 farthest(0);
        for (int i = 0; i < 200; ++i) {
            for (int k = 0; k <= 100; ++k) {
                const float a = 2 * kPi * static_cast<float>(i) / 200;
                const float b = kPi * static_cast<float>(k) / 100;
                Vec3 p = {std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a)};
                if (shape == WallShape::Box) {
                    p = glm::sign(p);
                } else if (shape == WallShape::Cylinder) {
                    p = {std::cos(a), p.y < 0 ? -1 : 1, std::sin(a)};
                }
                farthest = glm::max(farthest, glm::abs(turn * (p * half)));
            }
        }
        for (int i = 0; i < 3; ++i) {
            CHECK(placed.half_extent[i] == test::near(farthest[i]).epsilon(2e-3).scale(0));
            CHECK(placed.center[i] == test::near(i + 1));
        }
    }
}

TEST_CASE("water touch: a body in a small pool displaces its volume below the raised level") {
    World world;
    Schedule schedule = make_world_schedule();
    const Entity pool =
        world.create(Transform{}, Water{.size = {2, 1.5f}, .depth = 2}, WaterRipples{.damping = 2});
    world.create(
        Transform{.position = {0, 0.1f, 0}},
        WaterTouch{.shape = TouchShape::Box, .half = {0.6f, 0.5f, 0.5f}});
    for (int i = 0; i < 60; ++i) {
        step_world(world, schedule);
    }
    // V = A (0.4 + V / pool), a box of A = 1.2 in 3 m^2.
    const double volume = 1.2 * 0.4 / (1 - 1.2 / 3);
    CHECK(ripple_volume(world.get<RippleState>(pool)) == test::near(volume).epsilon(1e-3).scale(0));
}

TEST_CASE("water touch: a body that rides a swell displaces nothing, a fixed one does") {
    for (const bool rides : {true, false}) {
        World world;
        Schedule schedule = make_world_schedule();
        WaterWaves swell;
        swell.waves.push_back({.amplitude = 0.4f, .length = 12});
        const Entity pool = world.create(
            Transform{}, Water{.size = {8, 8}}, swell, WaterRipples{.cell = 0.2f, .damping = 1});
        const Entity body = world.create(
            Transform{}, WaterTouch{.shape = TouchShape::Box, .half = Vec3(0.3f, 0.5f, 0.3f)});
        double least = 1e9;
        double most = 0;
        for (int i = 0; i < 240; ++i) {
            step_world(world, schedule);
            const double volume = ripple_volume(world.get<RippleState>(pool));
            if (i > 1) {
                least = std::min(least, volume);
                most = std::max(most, volume);
            }
            const WaterSurface surface = {
                {}, world.get<Water>(pool), nullptr, &world.get<WaveTable>(pool)};
            const float height = sample_water(surface, {0, 0}).position.y;
            world.get<Transform>(body).position.y = rides ? height : 0.0f;
        }
        // Half of 0.36 m^3, and as high as 0.4 above and below.
        if (rides) {
            CHECK(most - least < 0.012);  // the body is a step late
            CHECK(least == test::near(0.18).epsilon(0.05).scale(0));
        } else {
            CHECK(most == test::near(0.36 * 0.9).epsilon(0.05).scale(0));
            CHECK(least == test::near(0.36 * 0.1).epsilon(0.15).scale(0));
        }
    }
}

TEST_CASE("water touch: a skinned body displaces the volume of its posed mesh") {
    Swimmer swimmer;
    CHECK(displaced(swimmer, -2) == test::near(kTrunk + kArm).epsilon(1e-4).scale(0));
    CHECK(displaced(swimmer, 2) == 0);
    CHECK(displaced(swimmer, 0) == test::near(0.5 * (kTrunk + kArm)).epsilon(1e-4).scale(0));
    // Up to the shoulder, with the arm along the surface, down in it, and up in the air.
    const float trunk = displaced(swimmer, -0.2f) - kArm;
    for (const float turn : {-1.570796f, 1.570796f}) {
        swimmer.pose.joints[1] = at({0.5f, 0, 0}, glm::angleAxis(turn, Vec3(0, 0, 1)));
        CHECK(
            displaced(swimmer, -0.2f)
            == test::near(turn < 0 ? trunk + kArm : trunk + 0.104f * kArm).epsilon(1e-2).scale(0));
    }
    // The whole character lies down: the same pose at another position.
    swimmer.pose.joints[1] = at({0.5f, 0, 0});
    const Quat lies = glm::angleAxis(1.570796f, Vec3(1, 0, 0));
    CHECK(displaced(swimmer, -0.21f, lies) == test::near(kTrunk + kArm).epsilon(1e-3).scale(0));
}

TEST_CASE("water touch: in a world it wades, raises the level, and displaces water at its limbs") {
    World world;
    Schedule schedule = make_world_schedule();
    start_world(world);
    const Swimmer swimmer;
    Assets& assets = *world.find_resource<Assets>();
    assets.meshes.push_back(swimmer.mesh);
    assets.skins.push_back(swimmer.skin);
    SkeletonData bones;
    bones.joints = {"trunk", "arm"};
    bones.parents = {-1, 0};
    bones.rest.translations = {Vec3(0), Vec3(0.5f, 0, 0)};
    bones.rest.rotations = {Quat(1, 0, 0, 0), Quat(1, 0, 0, 0)};
    bones.rest.scales = {Vec3(1), Vec3(1)};
    assets.skeletons.push_back(bones);
    const Entity pool =
        world.create(Transform{}, Water{.size = {6, 6}, .depth = 4}, WaterRipples{.damping = 1});
    const Entity body = world.create(
        Transform{.position = {0, -1, 0}}, MeshInstance{MeshId{0}, MaterialId{}},
        Skeleton{.skeleton = {0}}, WaterTouch{.shape = TouchShape::Mesh});
    world.add(body, Deformed{.character = body, .skin = {0}});
    for (int i = 0; i < 3; ++i) {
        step_world(world, schedule);
    }
    const RippleState& state = world.get<RippleState>(pool);
    CHECK(ripple_volume(state) == test::near(kTrunk + kArm).epsilon(1e-3).scale(0));
    const auto raised = [&](const Vec2& position) {
        const IVec2 cell(position / state.cell + 0.5f * Vec2(state.cells));
        return state.body[state.at(cell.x, cell.y)];
    };
    CHECK(raised({0, 0}) > 0.1f);
    CHECK(raised({1, 0}) > 0.02f);
    CHECK(raised({-1, 0}) == 0);
    CHECK(raised({0, 1}) == 0);

    // Another mesh is another body.
    MeshData trunk;
    add_box(trunk, {0, 0, 0}, {0.2f, 0.5f, 0.2f}, 0);
    assets.meshes.push_back(trunk);
    world.get<MeshInstance>(body).mesh = MeshId{1};
    for (int i = 0; i < 3; ++i) {
        step_world(world, schedule);
    }
    CHECK(world.get<TouchParts>(body).parts.size() == 1);
    CHECK(ripple_volume(state) == test::near(kTrunk).epsilon(1e-3).scale(0));
}

TEST_CASE("water touch: a mesh without joints uses its bounds; an open one fills its ellipsoid") {
    MeshData mesh;
    add_box(mesh, {0, 1, 0}, {0.2f, 0.3f, 0.4f}, 0);
    const TouchParts whole = make_touch_parts(mesh, nullptr);
    REQUIRE(whole.parts.size() == 1);
    CHECK(whole.parts[0].joint == -1);
    CHECK(whole.parts[0].center.y == test::near(1));
    CHECK(whole.fill == test::near(6 / 3.14159265));
    for (const bool inside_out : {false, true}) {
        MeshData bad = mesh;
        if (inside_out) {
            for (std::size_t i = 0; i < bad.indices.size(); i += 3) {
                std::swap(bad.indices[i], bad.indices[i + 1]);
            }
        } else {
            bad.indices.clear();
        }
        CHECK(make_touch_parts(bad, nullptr).fill == 1);
    }
    mesh.positions[0].x = std::numeric_limits<float>::quiet_NaN();
    mesh.indices[3] = 1000000;
    CHECK(make_touch_parts(mesh, nullptr).parts.size() <= 1);
    CHECK(make_touch_parts({}, nullptr).parts.empty());
    const SkinData other = Swimmer().skin;
    MeshData broken = mesh;
    broken.skin.weights.clear();
    CHECK(make_touch_parts(broken, &other).parts.size() <= 1);
}

TEST_CASE("water touch: a body without a finite position displaces nothing") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    for (const Vec3& position :
         {Vec3(nan, 0, 0), Vec3(0, nan, 0), Vec3(0, 0, -inf), Vec3(0, -inf, 0), Vec3(9, -9, 0)}) {
        World world;
        Schedule schedule = make_world_schedule();
        const Entity pool =
            world.create(Transform{}, Water{.size = {4, 3}}, WaterRipples{.cell = 0.1f});
        world.create(Transform{.position = position}, WaterTouch{});
        world.create(
            Transform{.position = {0, -1, 0}, .rotation = Quat(nan, 0, 0, 0)}, WaterTouch{});
        world.create(Transform{.position = {0, -1, 0}}, WaterTouch{.half = Vec3(inf)});
        world.create(Transform{.position = {0, -1, 0}, .scale = Vec3(0)}, WaterTouch{});
        for (int i = 0; i < 4; ++i) {
            step_world(world, schedule);
        }
        const RippleState& state = world.get<RippleState>(pool);
        CHECK(std::abs(ripple_volume(state)) < 1e-6);
        CHECK(sample_ripples(state, {0, 0}).height == 0);
    }
}

}  // namespace limn::water_touch_test
