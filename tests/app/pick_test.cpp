#include "content/app/player/pick.h"
#include "content/app/player/skin_drag.h"
#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/skin_pull.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/render_view.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace limn::pick_test {
namespace {

/// A unit square in the xy plane with its lower right half missing.
MeshData half_square() {
    MeshData mesh;
    mesh.positions = {{-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
    mesh.indices = {0, 1, 2};
    for (const Vec3& position : mesh.positions) {
        grow(mesh.bounds, position);
    }
    return mesh;
}

Entity add_mesh(World& world, const Vec3& position, const Vec3& scale = Vec3(1)) {
    return world.create(
        WorldTransform{affine_from(position, {1, 0, 0, 0}, scale)}, MeshInstance{{0}, {}});
}

}  // namespace

TEST_CASE("pick: the nearest triangle wins, not the nearest box") {
    World world;
    world.insert_resource(Assets{}).meshes.push_back(half_square());
    const Entity front = add_mesh(world, {0, 0, -1});
    const Entity back = add_mesh(world, {1, 0, -2}, Vec3(4));

    const auto left = pick_entity(world, {{-0.2f, 0.2f, 0}, {0, 0, -1}});
    REQUIRE(left);
    CHECK(left->entity == front);
    CHECK(left->distance == test::near(1.0f));
    // Through the missing half of the front one, inside its box.
    const auto right = pick_entity(world, {{0.2f, 0.1f, 0}, {0, 0, -1}});
    REQUIRE(right);
    CHECK(right->entity == back);
    const auto shifted = pick_entity(world, {{-0.6f, 0.2f, 0}, {0, 0, -1}});
    REQUIRE(shifted);
    CHECK(shifted->entity == back);
    CHECK(shifted->distance == test::near(2.0f));
}

TEST_CASE("pick: an inflated mesh is hit where it is drawn") {
    World world;
    MeshData mesh = half_square();
    mesh.normals.assign(3, {0, 0, 2});  // of any length
    world.insert_resource(Assets{}).meshes.push_back(mesh);
    const Entity entity = add_mesh(world, {0, 0, -3}, Vec3(2));
    world.add(entity, Inflate{.distance = 0.5f});
    const auto hit = pick_entity(world, {{-0.4f, 0.4f, 0}, {0, 0, -1}});
    REQUIRE(hit);
    CHECK(hit->distance == test::near(2.0f));
    CHECK(entity_bounds(world, entity).max.z == test::near(-2.0f));
    CHECK(entity_bounds(world, entity).max.x == test::near(2.0f));
}

TEST_CASE("pick: a posed mesh is hit where its joints move it") {
    World world;
    MeshData mesh = half_square();
    mesh.skin = {.first = {0, 1, 2, 3}, .joints = {0, 0, 0}, .weights = {1, 1, 1}};
    mesh.morphs = {
        {.name = "out",
         .action_unit = {},
         .vertices = {0, 1, 2},
         .positions = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
         .normals = {},
         .tangents = {}}};
    auto& assets = world.insert_resource(Assets{});
    assets.meshes.push_back(mesh);
    assets.skins.push_back({.name = "one", .joints = {0}, .joint_from_mesh = {Affine{}}});
    const Entity entity = add_mesh(world, {0, 0, -3});
    const Affine aside = affine_from({5, 0, 0}, {1, 0, 0, 0}, Vec3(1));
    world.add(entity, Pose{.joints = {aside}, .previous = {aside}});
    world.add(entity, MorphWeights{.weights = {0.5f}, .previous = {0.5f}});
    const Ray where_it_rests = {{-0.4f, 0.4f, 0}, {0, 0, -1}};
    const Ray where_it_is = {{4.6f, 0.4f, 0}, {0, 0, -1}};
    for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
        world.add(entity, Deformed{entity, {0}, 0, skinning});
        CHECK_FALSE(pick_entity(world, where_it_rests));
        const auto hit = pick_entity(world, where_it_is);
        REQUIRE(hit);
        CHECK(hit->distance == test::near(2.5f));
        CHECK(entity_bounds(world, entity).min.x == test::near(4.5f));
        world.remove<Deformed>(entity);
    }
    // What has lost its character is drawn, and met, at rest.
    world.add(entity, Deformed{{}, {0}, 0, Skinning::Linear});
    CHECK(pick_entity(world, where_it_rests));
    CHECK_FALSE(pick_entity(world, where_it_is));
}

TEST_CASE("pick: nothing is hit behind the camera or without meshes") {
    World world;
    CHECK_FALSE(pick_entity(world, {}));
    world.insert_resource(Assets{}).meshes.push_back(half_square());
    add_mesh(world, {0, 0, 1});
    CHECK_FALSE(pick_entity(world, {{-0.2f, 0.2f, 0}, {0, 0, -1}}));
}

TEST_CASE("pick: the ray through the center of the image is the camera's view direction") {
    const Affine pose = look_at({1, 2, 3}, {4, 0, -5});
    const RenderView view = make_render_view(Camera{}, pose, pose, {.width = 640, .height = 360});
    const Ray ray = ray_through(view, {0.5f, 0.5f});
    CHECK(glm::distance(ray.origin, Vec3(1, 2, 3)) < 1e-5f);
    CHECK(glm::distance(ray.direction, glm::normalize(Vec3(3, -2, -8))) < 1e-5f);
    // A corner's ray projects back to the corner.
    const Vec3 point = [&] {
        const Ray corner = ray_through(view, {0.0f, 0.0f});
        return corner.origin + corner.direction * 7.0f;
    }();
    const Vec4 clip = view.unjittered_from_world * Vec4(point, 1.0f);
    CHECK(clip.x / clip.w == test::near(-1.0f).epsilon(1e-4));
    CHECK(clip.y / clip.w == test::near(1.0f).epsilon(1e-4));
}

TEST_CASE(
    "skin drag: only a drag that begins on skin pulls, until the button is up"
    * technique("face.pull")) {
    World world;
    world.insert_resource(Assets{}).meshes.push_back(half_square());
    const Entity face = add_mesh(world, {0, 0, -1});
    const Entity brow = add_mesh(world, {2, 0, -1});
    const Entity wall = add_mesh(world, {4, 0, -1});
    for (const Entity entity : {face, brow, wall}) {
        world.add(entity, Deformed{entity == wall ? wall : face, {}});
    }
    const auto onto = [](float x) { return Ray{{x - 0.2f, 0.2f, 0}, {0, 0, -1}}; };
    CHECK_FALSE(is_pullable(world, onto(0)));
    world.add(face, PullableSkin{});
    CHECK(is_pullable(world, onto(0)));
    CHECK_FALSE(is_pullable(world, onto(2)));  // it would not follow
    world.add(brow, Deformers{});
    world.add(wall, Deformers{});
    CHECK(is_pullable(world, onto(2)));
    CHECK_FALSE(is_pullable(world, onto(4)));
    CHECK_FALSE(is_pullable(world, onto(9)));

    SkinDrag drag;
    const auto pulls = [&](float x, bool left, bool blocked = false) {
        drag.follow(world, onto(x), left, blocked);
        return drag.pulls();
    };
    CHECK_FALSE(pulls(0, false));
    CHECK(pulls(0, true));
    CHECK(pulls(9, true));
    CHECK(pulls(9, true, true));
    CHECK_FALSE(pulls(0, false));
    CHECK_FALSE(pulls(9, true));
    CHECK_FALSE(pulls(0, true));
    CHECK_FALSE(pulls(0, false));
    CHECK(pulls(0, true));  // again
    CHECK_FALSE(pulls(0, false));
    CHECK_FALSE(pulls(0, true, true));  // on a panel before it
    CHECK_FALSE(pulls(0, true));
}

}  // namespace limn::pick_test
