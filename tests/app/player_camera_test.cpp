#include "content/app/player/player_camera.h"
#include "ecs/components/camera.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/render_view.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace limn::player_camera_test {
namespace {

Vec3 position_of(const Affine& pose) {
    return {pose.row[0].w, pose.row[1].w, pose.row[2].w};
}
Vec3 forward_of(const Affine& pose) {
    return -Vec3(pose.row[0].z, pose.row[1].z, pose.row[2].z);
}

void check_near(const Vec3& a, const Vec3& b, float tolerance = 1e-4f) {
    CAPTURE(a.x);
    CAPTURE(a.y);
    CAPTURE(a.z);
    CHECK(glm::distance(a, b) <= tolerance);
}

}  // namespace

TEST_CASE("player_camera: an event that switches cameras switches what is seen") {
    World world;
    const Entity first = world.create(Transform{}, WorldTransform{}, Camera{});
    const Entity second = world.create(Transform{}, WorldTransform{}, Camera{.active = false});
    CHECK(follow_active_camera(world, first) == first);
    world.get<Camera>(second).active = true;
    CHECK(follow_active_camera(world, first) == first);
    world.get<Camera>(first).active = false;
    CHECK(follow_active_camera(world, first) == second);
    world.get<Camera>(second).active = false;
    CHECK(follow_active_camera(world, second) == second);
}

TEST_CASE("player_camera: flying takes over exactly where the camera stood") {
    const Affine pose = look_at({3, 4, 5}, {0, 1, -2});
    PlayerCamera camera;
    start_fly(camera, pose);
    step_fly(camera, {}, 1.0f / 60.0f);
    check_near(position_of(camera.pose), {3, 4, 5});
    check_near(forward_of(camera.pose), forward_of(pose));
}

TEST_CASE("player_camera: W flies forward at its pace of the distance ahead, with Shift five times "
          "as fast") {
    for (const bool fast : {false, true}) {
        PlayerCamera camera;
        camera.pace = 0.5f;
        camera.view_distance = 4.0f;
        start_fly(camera, look_at({0, 0, 0}, {0, 0, -1}));
        for (int i = 0; i < 60; ++i) {  // until it has got up speed
            step_fly(camera, {.move = {0, 0, 1}, .fast = fast}, 1.0f / 60.0f);
        }
        const float before = camera.fly_pose.position.z;
        for (int i = 0; i < 60; ++i) {
            step_fly(camera, {.move = {0, 0, 1}, .fast = fast}, 1.0f / 60.0f);
        }
        CHECK(
            camera.fly_pose.position.z - before == test::near(fast ? -10.0f : -2.0f).epsilon(1e-3));
    }
}

TEST_CASE("player_camera: the flying speed follows the distance ahead, up to the scene's radius") {
    PlayerCamera camera;
    start_fly(camera, look_at({0, 0, 0}, {0, 0, -1}));
    const auto speed_before = [&](float ahead) {
        for (int i = 0; i < 300; ++i) {
            update_view_distance(camera, ahead, 40.0f, 1.0f / 60.0f);
        }
        step_fly(camera, {}, 1.0f / 60.0f);
        return camera.fly.speed;
    };
    CHECK(speed_before(10.0f) == test::near(6.0).epsilon(1e-3));
    CHECK(speed_before(1.0f) == test::near(0.6).epsilon(1e-3));
    CHECK(speed_before(INFINITY) == test::near(24.0).epsilon(1e-3));
    CHECK(speed_before(0.0f) == test::near(0.1).epsilon(1e-3));  // no wall stops it
    step_fly(camera, {.zoom = 2}, 1.0f / 60.0f);
    CHECK(camera.pace == test::near(0.6 * 1.2 * 1.2).epsilon(1e-5));
}

TEST_CASE("player_camera: it stays above the floor unless steered down") {
    PlayerCamera camera;
    start_fly(camera, look_at({0, 1, 0}, {0, 0, -1}));
    for (int i = 0; i < 300; ++i) {
        camera.previous = camera.pose =
            affine_from(camera.fly_pose.position, camera.fly_pose.rotation, Vec3(1));
        step_fly(camera, {.move = {0, 0, 1}}, 1.0f / 60.0f);
        stop_at_floor(camera, position_of(camera.previous).y);
    }
    CHECK(camera.fly_pose.position.y == test::near(kEyeHeight).epsilon(1e-3));
    CHECK(camera.fly_pose.position.z < -5.0f);  // it glides along
    stop_at_floor(camera, std::nullopt);
    CHECK(camera.fly_pose.position.y == test::near(kEyeHeight).epsilon(1e-3));
    camera.previous =
        affine_from({0, 0.1f, 0}, camera.fly_pose.rotation, Vec3(1));  // already below
    camera.fly_pose.position.y = 0.05f;
    stop_at_floor(camera, 0.1f);
    CHECK(camera.fly_pose.position.y == 0.05f);
}

TEST_CASE("player_camera: a framed box fills most of the image's height") {
    const PlayerCamera camera;
    const float distance = framing_distance(camera, 2.0f, 1.5f);
    const float fraction = std::asin(2.0f / distance) / (0.5f * camera.lens.fov_y);
    CHECK(fraction > 0.8f);
    CHECK(fraction < 1.0f);
}

TEST_CASE("player_camera: in an upright image a framed box fills most of the width") {
    const PlayerCamera camera;
    const float distance = framing_distance(camera, 2.0f, 0.25f);
    const float half_width = std::atan(0.25f * std::tan(0.5f * camera.lens.fov_y));
    const float fraction = std::asin(2.0f / distance) / half_width;
    CHECK(fraction > 0.8f);
    CHECK(fraction < 1.0f);
}

TEST_CASE("player_camera: around a model of any size, the camera moves as around one of 1 m") {
    const auto move = [](float unit) {
        PlayerCamera camera;
        camera.unit = unit;
        camera.view_distance = 5 * unit;
        start_orbit(camera, look_at(unit * Vec3(3, 4, 5), {0, 0, 0}), {0, 0, 0});
        for (int i = 0; i < 90; ++i) {  // in as far as it goes
            step_orbit(camera, {.zoom = 1}, {0, 0, 0}, 1.0f / 60.0f);
        }
        const float nearest = camera.orbit.distance;
        start_fly(camera, camera.pose);
        for (int i = 0; i < 60; ++i) {
            update_view_distance(camera, nearest, 2 * unit, 1.0f / 60.0f);
            step_fly(camera, {.move = {0, 0, -1}}, 1.0f / 60.0f);
        }
        return Vec3(nearest, position_of(camera.pose).y, position_of(camera.pose).z) / unit;
    };
    const Vec3 one = move(1);
    for (const float unit : {1e-4f, 100.0f, 2e4f}) {
        check_near(move(unit), one);
    }
}

TEST_CASE("player_camera: two keys at once are no faster than one") {
    PlayerCamera camera;
    start_fly(camera, look_at({0, 0, 0}, {0, 0, -1}));
    for (int i = 0; i < 120; ++i) {
        step_fly(camera, {.move = {1, 0, 1}}, 1.0f / 60.0f);
    }
    const Vec3 before = camera.fly_pose.position;
    step_fly(camera, {.move = {1, 0, 1}}, 1.0f);
    CHECK(
        glm::distance(before, camera.fly_pose.position)
        == test::near(camera.fly.speed).epsilon(1e-3));
}

TEST_CASE("player_camera: looking up stops short of vertical") {
    PlayerCamera camera;
    start_fly(camera, look_at({0, 0, 0}, {0, 0, -1}));
    for (int i = 0; i < 100; ++i) {
        step_fly(camera, {.look = {0, -50}}, 1.0f / 60.0f);
    }
    CHECK(forward_of(camera.pose).y > 0.99f);
    CHECK(std::isfinite(camera.pose.row[0].x));
    CHECK(camera.pose.row[1].y > 0.0f);  // its up still points up
}

TEST_CASE("player_camera: orbit starts where the camera stood and keeps its distance") {
    PlayerCamera camera;
    start_orbit(camera, look_at({0, 3, 4}, {9, 9, 9}), {0, 0, 0});
    step_orbit(camera, {}, {0, 0, 0}, 1.0f / 60.0f);
    check_near(position_of(camera.pose), {0, 3, 4});
    for (int i = 0; i < 20; ++i) {
        step_orbit(camera, {.look = {37, -21}}, {0, 0, 0}, 1.0f / 60.0f);
        CHECK(glm::length(position_of(camera.pose)) == test::near(5.0f).epsilon(1e-4));
        check_near(forward_of(camera.pose), -position_of(camera.pose) / 5.0f, 1e-3f);
    }
}

TEST_CASE("player_camera: the lag is the same at 30 and at 60 frames a second") {
    PlayerCamera slow;
    start_orbit(slow, look_at({0, 0, 5}, {0, 0, 0}), {0, 0, 0});
    PlayerCamera quick = slow;
    const Vec3 target = {10, 0, 0};
    step_orbit(slow, {}, target, 1.0f / 30.0f);
    step_orbit(quick, {}, target, 1.0f / 60.0f);
    CHECK(quick.focus.x == test::near(9.0f).epsilon(1e-4));  // follow 0.9 leaves a tenth
    step_orbit(quick, {}, target, 1.0f / 60.0f);
    CHECK(quick.focus.x == test::near(9.9f).epsilon(1e-4));
    CHECK(slow.focus.x == test::near(quick.focus.x).epsilon(1e-4));
}

TEST_CASE("player_camera: the point in focus follows the pointer when the orbit is panned") {
    PlayerCamera camera;
    const Vec3 target = {1, 2, 3};
    start_orbit(camera, look_at({4, 6, 9}, target), target);
    step_orbit(camera, {}, camera.aim, 1.0f / 60.0f);
    const IVec2 size = {640, 360};
    const Vec2 motion = {50, -20};
    pan_orbit(camera, motion, static_cast<float>(size.y));
    step_orbit(camera, {}, camera.aim, 1.0f / 60.0f);
    const RenderView view = make_render_view(
        camera.lens, camera.pose, camera.pose, {.width = size.x, .height = size.y});
    const Vec4 clip = view.clip_from_world * Vec4(target, 1);
    const Vec2 pixel = Vec2(0.5f * clip.x / clip.w, -0.5f * clip.y / clip.w) * Vec2(size);
    CHECK(pixel.x == test::near(motion.x).epsilon(1e-3));
    CHECK(pixel.y == test::near(motion.y).epsilon(1e-3));
}

}  // namespace limn::player_camera_test
