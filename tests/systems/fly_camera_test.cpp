#include "ecs/world.h"
#include "systems/fly_camera_system.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::fly_camera_test {
namespace {

constexpr FlyCamera kFly = {.speed = 2.0f, .sensitivity = 0.01f};

Vec3 forward(const Transform& transform) {
    return transform.rotation * Vec3(0, 0, -1);
}
Vec3 right(const Transform& transform) {
    return transform.rotation * Vec3(1, 0, 0);
}

}  // namespace

TEST_CASE("fly_camera: keys move it along the view, at its speed") {
    Transform camera;
    step_fly_camera(camera, kFly, {.move = {0, 0, 1}}, 0.5f);
    CHECK(glm::length(camera.position - Vec3(0, 0, -1)) < 1e-6f);
    step_fly_camera(camera, kFly, {.move = {1, 0, 0}, .fast = true}, 0.5f);
    CHECK(glm::length(camera.position - Vec3(5, 0, -1)) < 1e-5f);
    Transform diagonal;
    step_fly_camera(diagonal, kFly, {.move = {1, 1, 1}}, 0.5f);
    CHECK(glm::length(diagonal.position) == test::near(1.0f));  // not faster askew
}

TEST_CASE("fly_camera: up is world up, however the camera is tilted") {
    Transform camera = {.rotation = glm::angleAxis(-1.0f, Vec3(1, 0, 0))};
    step_fly_camera(camera, kFly, {.move = {0, 1, 0}}, 1);
    CHECK(glm::length(camera.position - Vec3(0, 2, 0)) < 1e-6f);
}

TEST_CASE("fly_camera: moving the mouse right rotates right, down tilts down, and the horizon "
          "stays level") {
    Transform camera;
    step_fly_camera(camera, kFly, {.look = {50, 0}}, 1);
    CHECK(glm::length(forward(camera) - Vec3(std::sin(0.5f), 0, -std::cos(0.5f))) < 1e-6f);
    step_fly_camera(camera, kFly, {.look = {0, 30}}, 1);
    CHECK(forward(camera).y == test::near(-std::sin(0.3f)));
    for (int i = 0; i < 500; ++i) {
        step_fly_camera(
            camera, kFly,
            {.look =
                 {17.0f * std::sin(0.1f * static_cast<float>(i)),
                  9.0f * std::cos(0.3f * static_cast<float>(i))}},
            1);
    }
    CHECK(std::abs(right(camera).y) < 1e-4f);
    CHECK(glm::length(camera.rotation) == test::near(1.0f));
}

TEST_CASE("fly_camera: it can look nearly straight up, never beyond, and can return") {
    Transform camera;
    for (int i = 0; i < 400; ++i) {
        step_fly_camera(camera, kFly, {.look = {0, -3}}, 1);
        CHECK((camera.rotation * Vec3(0, 1, 0)).y >= 0);
    }
    CHECK(forward(camera).y > 0.999f);
    CHECK(forward(camera).y < 1.0f);
    step_fly_camera(camera, kFly, {.look = {0, -100000}}, 1);
    CHECK((camera.rotation * Vec3(0, 1, 0)).y >= 0);
    for (int i = 0; i < 100; ++i) {
        step_fly_camera(camera, kFly, {.look = {0, 3}}, 1);
    }
    CHECK(forward(camera).y < 0);
}

TEST_CASE("fly_camera: without input nothing is written, and inactive cameras stay") {
    World world;
    world.insert_resource(Input{});
    world.insert_resource(FrameTime{});
    const Entity active = world.create(Transform{}, kFly, Camera{});
    const Entity idle = world.create(Transform{}, kFly, Camera{.active = false});
    const std::uint32_t since = world.version();
    world.run(update_fly_cameras);
    CHECK(world.query<const Transform, Changed<Transform>>().since(since).count() == 0);
    set_action(world.resource<Input>(), "move_forward");
    world.run(update_fly_cameras);
    CHECK(world.get<Transform>(active).position.z < 0);
    CHECK(world.get<Transform>(idle).position.z == 0);
}

}  // namespace limn::fly_camera_test
