#include "ecs/base/rotation.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/height_field.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "systems/animation/ik/foot_ground_system.h"
#include "systems/update_world.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace limn::foot_plant_test {

using namespace limn::test;

namespace {

/// Hips and two legs of 0.4 m links, ankles 0.1 m above the floor, knees slightly bent.
SkeletonData make_legs() {
    SkeletonData skeleton;
    skeleton.name = "legs";
    const auto add = [&](const char* name, std::int32_t parent, const Vec3& offset) {
        skeleton.joints.emplace_back(name);
        skeleton.parents.push_back(parent);
        skeleton.rest.translations.push_back(offset);
        skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
        skeleton.rest.scales.emplace_back(1, 1, 1);
    };
    add("Hips", -1, {0, 0.9f, 0});
    for (const float side : {1.0f, -1.0f}) {
        const auto hips = static_cast<std::int32_t>(skeleton.joints.size());
        const bool left = side > 0;
        add(left ? "LeftUpLeg" : "RightUpLeg", 0, {0.1f * side, -0.02f, 0});
        add(left ? "LeftLeg" : "RightLeg", hips, {0, -0.385f, 0.06f});
        add(left ? "LeftFoot" : "RightFoot", hips + 1, {0, -0.385f, -0.06f});
    }
    return skeleton;
}

/// Stairs along +x: a level quad from x = -1 to 0 at y = 0, and one from 0 to 1 at y = 0.2.
MeshData make_stairs() {
    MeshData mesh;
    for (const float x : {-1.0f, 0.0f}) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const float y = x < 0 ? 0.0f : 0.2f;
        for (const Vec3& corner :
             {Vec3(x, y, -1), Vec3(x, y, 1), Vec3(x + 1, y, 1), Vec3(x + 1, y, -1)}) {
            mesh.positions.push_back(corner);
            mesh.normals.emplace_back(0, 1, 0);
        }
        for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) {
            mesh.indices.push_back(first + i);
        }
    }
    return mesh;
}

constexpr float kAnkle = 0.11f;  // above the floor, at rest

struct Stage {
    World world;
    Schedule schedule = make_world_schedule();
    Entity character;

    explicit Stage(const Transform& place = {}) {
        Assets assets;
        assets.skeletons.push_back(make_legs());
        assets.meshes.push_back(make_stairs());
        world.insert_resource(std::move(assets));
        character = world.create(place, Skeleton{{0}}, FootPlant{.softness = 0});
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    Vec3 joint(std::size_t index) {
        return transform_point(
            world.get<const WorldTransform>(character).world,
            transform_point(world.get<const Pose>(character).joints[index], Vec3(0)));
    }
    Vec3 left() { return joint(3); }
    Vec3 right() { return joint(6); }
    Vec3 up_of(std::size_t foot) {
        return transform_vector(
            world.get<const WorldTransform>(character).world
                * world.get<const Pose>(character).joints[foot],
            {0, 1, 0});
    }
    /// The point of a sole below the ankle.
    Vec3 sole(std::size_t foot) { return joint(foot) - kAnkle * up_of(foot); }
};

}  // namespace

TEST_CASE("foot plant: on stairs each foot stands on its step, and the hips stay low enough") {
    Stage stage;
    stage.world.create(Transform{}, MeshInstance{.mesh = {0}, .material = {}}, Walkable{});
    stage.step(3);
    CHECK(stage.left().y == near(0.2 + double(kAnkle)).epsilon(1e-3));
    CHECK(stage.right().y == near(double(kAnkle)).epsilon(1e-3));
    CHECK(stage.joint(0).y == near(0.9).epsilon(1e-3));
    CHECK(stage.left().x == near(0.1).epsilon(1e-3));
    // A level 0.3 m below: the hips go down.
    Stage low;
    low.world.create(
        Transform{.position = {0, -0.3f, 0}}, MeshInstance{.mesh = {0}, .material = {}},
        Walkable{});
    low.step(3);
    CHECK(low.left().y == near(-0.1 + double(kAnkle)).scale(1).epsilon(1e-3));
    CHECK(low.right().y == near(-0.3 + double(kAnkle)).epsilon(1e-3));
    CHECK(low.joint(0).y == near(0.6).epsilon(1e-3));
}

TEST_CASE("foot plant: a plane that is tilted lifts and turns the feet, also under a turned body") {
    const float angle = 0.25f;
    Stage stage({.position = {0, 1, 0}, .rotation = rotation_about({0, 1, 0}, 0.7f)});
    stage.world.create(
        Transform{.position = {0, 1, 0}, .rotation = rotation_about({1, 0, 0}, angle)}, Walkable{});
    stage.step(3);
    for (const std::size_t foot : {std::size_t{3}, std::size_t{6}}) {
        const Vec3 at = stage.sole(foot);
        CHECK(at.y == near(double(1 - at.z * std::tan(angle))).epsilon(1e-3));
        const Vec3 up = stage.up_of(foot);
        CHECK(std::acos(std::min(up.y, 1.0f)) == near(0.8 * double(angle)).epsilon(2e-2));
        CHECK(up.z > 0);
    }
}

TEST_CASE("foot plant: a deck that heaves carries the feet in the same step") {
    Stage stage;
    const Entity deck = stage.world.create(Transform{}, Walkable{});
    stage.step(10);
    for (int i = 0; i < 60; ++i) {
        const float height = 0.2f * std::sin(0.2f * static_cast<float>(i));
        stage.world.get<Transform>(deck).position.y = height;
        stage.step();
        CHECK(stage.left().y == near(double(height + kAnkle)).scale(1).epsilon(1e-4));
    }
}

TEST_CASE("foot plant: planted feet do not slide while the ground turns and heaves under them") {
    Stage stage;
    const Entity deck = stage.world.create(Transform{}, Walkable{});
    stage.step(30);
    const Vec3 before = stage.sole(3);
    for (int i = 0; i < 40; ++i) {
        stage.world.get<Transform>(deck).rotation =
            rotation_about({0, 0, 1}, 0.1f * std::sin(0.1f * static_cast<float>(i)));
        stage.step();
        CHECK(std::abs(stage.sole(3).x - before.x) < 0.002f);
        CHECK(std::abs(stage.sole(3).z - before.z) < 0.002f);
    }
}

TEST_CASE(
    "foot plant: new ground below a foot is followed with a delay; without any, as animated") {
    Stage stage;
    stage.step(3);
    CHECK(stage.left().y == near(double(kAnkle)).epsilon(1e-3));
    stage.world.create(Transform{.position = {0, 0.2f, 0}}, Walkable{});
    stage.step();
    CHECK(stage.left().y < 0.1f + kAnkle);
    CHECK(stage.left().y > 0.01f + kAnkle);
    stage.step(60);
    CHECK(stage.left().y == near(0.2 + double(kAnkle)).epsilon(1e-3));
    CHECK(stage.joint(0).y == near(1.1).epsilon(1e-3));
}

TEST_CASE("foot plant: ground out of a step's height is not reached for; bad grounds are ignored") {
    Stage stage;
    stage.world.create(Transform{.position = {0, 0.8f, 0}}, Walkable{});
    stage.world.create(Transform{.position = {0, -0.9f, 0}}, Walkable{});
    stage.world.create(Transform{.position = {0, 0.3f, 0}, .scale = {1, 0, 1}}, Walkable{});
    stage.world.create(Transform{}, HeightField{}, Walkable{});
    stage.step(5);
    CHECK(stage.left().y == near(double(kAnkle)).epsilon(1e-3));
    stage.world.get<FootPlant>(stage.character).weight = NAN;
    stage.step();
    CHECK(is_finite(stage.left()));
}

TEST_CASE("foot plant: heights of a field are bilinear, with its slope, and none outside") {
    HeightField field = {.points = 3, .size = {4, 2}};
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            const float x = 2.0f * static_cast<float>(i) - 2;
            const float z = static_cast<float>(j) - 1;
            field.height.push_back(0.5f * x - 0.25f * z + 1);
        }
    }
    for (const Vec2& at : {Vec2(0, 0), Vec2(1.3f, -0.4f), Vec2(-2, 1), Vec2(2, 1)}) {
        const auto hit = find_height(field, at.x, at.y);
        REQUIRE(hit);
        CHECK(hit->height == near(double(0.5f * at.x - 0.25f * at.y + 1)).scale(1));
        const Vec3 normal = normalize_or(Vec3(-0.5f, 1, 0.25f), {});
        CHECK(glm::distance(hit->normal, normal) < 1e-5f);
    }
    CHECK_FALSE(find_height(field, 2.1f, 0));
    CHECK_FALSE(find_height(field, NAN, 0));
    CHECK_FALSE(find_height(HeightField{}, 0, 0));
}

}  // namespace limn::foot_plant_test
