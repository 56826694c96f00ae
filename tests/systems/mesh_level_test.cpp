#include "ecs/world.h"
#include "systems/mesh_level_system.h"
#include "systems/update_world.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

namespace limn::mesh_level_test {

TEST_CASE(
    "mesh_levels: they increase with size on screen, and do not flicker"
    * technique("anim.bezier-patch-lod, engine.lod-mesh")) {
    int last = 0;
    for (float pixels = 1; pixels < 4096; pixels *= 1.05f) {
        const int level = choose_mesh_level(pixels, 6, last);
        CHECK(level >= last);
        last = level;
    }
    CHECK(last == 5);
    CHECK(choose_mesh_level(64, 6, 0) == 2);  // 8 quads of 8 pixels would be level 3 ...
    CHECK(choose_mesh_level(71, 6, 0) == 3);  // ... but only 10 % beyond
    CHECK(choose_mesh_level(63, 6, 3) == 3);  // and back 10 % below
    CHECK(choose_mesh_level(57, 6, 3) == 2);
    CHECK(choose_mesh_level(0, 6, 3) == 0);
}

TEST_CASE(
    "mesh_levels: an entity has a finer mesh near the camera, at any scale"
    * technique("anim.bezier-patch-lod, engine.lod-mesh")) {
    World world;
    const std::vector<MeshId> meshes = {{4}, {5}, {6}, {7}};
    const MeshLevels levels{.meshes = meshes, .span = 0.5f, .pixels_per_quad = 54};
    // A camera of 90 degrees sees 2 d meters over 1080 rows at a distance of d: half a meter is
    // 270 / d pixels, 5 / d quads of 54.
    world.create(Transform{}, Camera{.fov_y = radians(90.0f)});
    const auto add = [&](float distance, float scale) {
        return world.create(
            Transform{.position = {0, 0, -distance}, .scale = Vec3(scale)}, levels,
            MeshInstance{.mesh = meshes[0], .material = {}});
    };
    const Entity near = add(0.5f, 1);    // 10 quads
    const Entity middle = add(1.0f, 1);  // 5
    const Entity far = add(4.0f, 1);     // 1.25
    const Entity large = add(4.0f, 4);   // 5
    Schedule schedule = make_world_schedule();
    start_world(world);
    step_world(world, schedule);
    const auto mesh_of = [&](Entity entity) {
        return std::as_const(world).get<MeshInstance>(entity).mesh.index;
    };
    CHECK(mesh_of(near) == 7);
    CHECK(mesh_of(middle) == 6);
    CHECK(mesh_of(far) == 4);
    CHECK(mesh_of(large) == 6);

    // An image of half the rows halves the quads, and levels with them.
    world.insert_resource(Rendering{.level_rows = 540});
    step_world(world, schedule);
    CHECK(mesh_of(near) == 6);
    CHECK(mesh_of(middle) == 5);
    CHECK(mesh_of(far) == 4);
    CHECK(mesh_of(large) == 5);
}

TEST_CASE(
    "mesh_levels: what is smaller than it is drawn from has no mesh, and does not flicker"
    * technique("engine.lod-mesh")) {
    World world;
    const std::vector<MeshId> meshes = {{4}, {5}};
    // One meter is 540 / d pixels long.
    world.create(Transform{}, Camera{.fov_y = radians(90.0f)});
    const Entity tooth = world.create(
        Transform{.position = {0, 0, -1}},
        MeshLevels{.meshes = meshes, .span = 1, .pixels_per_quad = 100, .drawn_from = 100},
        MeshInstance{.mesh = meshes[0], .material = {}});
    Schedule schedule = make_world_schedule();
    start_world(world);
    const auto mesh_at = [&](float distance) {
        world.get<Transform>(tooth).position.z = -distance;
        step_world(world, schedule);
        return std::as_const(world).get<MeshInstance>(tooth).mesh;
    };
    CHECK(mesh_at(1) == MeshId{5});
    CHECK(mesh_at(5.3f) == MeshId{4});
    CHECK(mesh_at(5.5f) == MeshId{});
    CHECK(mesh_at(5.3f) == MeshId{});   // 102 px: not yet 10 % beyond
    CHECK(mesh_at(4.8f) == MeshId{4});  // 112 px
}

}  // namespace limn::mesh_level_test
