#include "ecs/components/camera_path.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace limn;

namespace {

CameraPath path_through(const std::vector<Vec3>& places, const std::vector<float>& times) {
    CameraPath path;
    for (std::size_t i = 0; i < places.size(); ++i) {
        CameraKey key;
        key.time = times[i];
        key.position = places[i];
        key.look_at = places[i] + Vec3(0, 0, -5);
        path.keys.push_back(key);
    }
    return path;
}

/// A walk with turns, unequal distances and unequal times.
CameraPath walk() {
    return path_through(
        {{0, 1, 0}, {4, 1, 0}, {5, 1.5f, -1}, {5, 2, -8}, {0, 1, -3}}, {0, 2, 3, 7, 9});
}

Vec3 velocity(const CameraPath& path, double time, double h) {
    return (camera_pose(path, time + h).position - camera_pose(path, time).position)
           / static_cast<float>(h);
}

Vec3 ahead(const Quat& q) {
    return q * Vec3(0, 0, -1);
}
Vec3 right(const Quat& q) {
    return q * Vec3(1, 0, 0);
}

}  // namespace

TEST_CASE("camera path: it is at every key at its time and stays at the last one") {
    const CameraPath path = walk();
    for (const CameraKey& key : path.keys) {
        CHECK(
            glm::length(camera_pose(path, static_cast<double>(key.time)).position - key.position)
            < 1e-5f);
    }
    CHECK(camera_pose(path, -3).position == path.keys.front().position);
    CHECK(glm::length(camera_pose(path, 1e9).position - path.keys.back().position) < 1e-5f);
    CHECK(camera_duration(path) == 9.0);
}

TEST_CASE("camera path: evenly spaced keys on a line give constant speed") {
    const CameraPath path =
        path_through({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {6, 0, 0}}, {0, 1, 2, 3});
    for (double t = 0; t <= 3; t += 0.1) {
        CHECK(camera_pose(path, t).position.x == test::near(2.0 * t).epsilon(1e-4));
    }
}

TEST_CASE("camera path: speed and direction are continuous at the keys") {
    const CameraPath path = walk();
    for (const double t : {2.0, 3.0, 7.0}) {
        const Vec3 before = velocity(path, t, -0.002);
        const Vec3 after = velocity(path, t, 0.002);
        CAPTURE(t);
        CHECK(glm::length(before - after) < 0.03f * glm::length(after) + 0.01f);
        CHECK(glm::dot(glm::normalize(before), glm::normalize(after)) > 0.9995f);
    }
}

TEST_CASE("camera path: on a line it never moves backward, however uneven the times") {
    const CameraPath path =
        path_through({{0, 0, 0}, {1, 0, 0}, {9, 0, 0}, {10, 0, 0}}, {0, 5, 5.5f, 12});
    float last = 0;
    for (double t = 0; t <= 12; t += 0.02) {
        const float x = camera_pose(path, t).position.x;
        CHECK(x >= last - 1e-5f);
        last = x;
    }
}

TEST_CASE("camera path: between two keys at one position it stands still but may rotate") {
    CameraPath path = path_through({{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 0, 4}}, {0, 1, 2, 3});
    path.keys[1].look_at = {3, 0, -5};
    path.keys[2].look_at = {8, 0, 0};
    for (double t = 1; t <= 2; t += 0.05) {
        CHECK(glm::length(camera_pose(path, t).position - Vec3(3, 0, 0)) < 1e-5f);
    }
    CHECK(glm::length(velocity(path, 1.0, -0.01)) < 0.2f);  // it slows down for that
    CHECK(
        glm::dot(ahead(camera_pose(path, 1).rotation), ahead(camera_pose(path, 2).rotation))
        < 0.1f);
}

TEST_CASE("camera path: a loop repeats and is continuous at its seam") {
    CameraPath path =
        path_through({{0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {0, 0, 4}, {0, 0, 0}}, {0, 2, 4, 6, 8});
    path.loop = true;
    for (double t = 0; t < 8; t += 0.37) {
        CHECK(
            glm::length(camera_pose(path, t).position - camera_pose(path, t + 16).position)
            < 1e-4f);
    }
    CHECK(glm::length(velocity(path, 8, 0.002)) > 1.5f);
    CHECK(glm::length(velocity(path, 8, -0.002) - velocity(path, 8, 0.002)) < 0.03f);
}

TEST_CASE("camera path: along a curve its speed is even between evenly spaced keys") {
    std::vector<Vec3> corners;
    std::vector<float> times;
    for (int i = 0; i <= 5; ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / 5.0f;
        corners.emplace_back(3.0f * std::cos(angle), 0.0f, 3.0f * std::sin(angle));
        times.push_back(2.0f * static_cast<float>(i));
    }
    CameraPath path = path_through(corners, times);
    path.loop = true;
    const float speed = glm::length(velocity(path, 1.0, 0.01));
    CHECK(speed > 1.8f);  // a circle's would be 1.885
    for (double t = 0; t < 10; t += 0.13) {
        CHECK(glm::length(velocity(path, t, 0.01)) == test::near(speed).epsilon(0.01));
    }
}

TEST_CASE("camera path: aims point at their target, with a level horizon") {
    CameraPath path = walk();
    for (double t = 0; t <= 9; t += 0.25) {
        const CameraPose pose = camera_pose(path, t);
        CHECK(std::abs(right(pose.rotation).y) < 1e-5f);
    }
    path.aim = CameraAim::Target;
    const Vec3 target(1, 7, 2);
    const CameraPose pose = camera_pose(path, 4.2, target);
    CHECK(glm::length(ahead(pose.rotation) - glm::normalize(target - pose.position)) < 1e-5f);
    path.keys.clear();
    CHECK(camera_pose(path, 1).rotation == Quat(1, 0, 0, 0));
}

TEST_CASE("camera path: roll tips the camera about its view axis") {
    const Quat q = look_along({0, 0, -1}, radians(30.0f));
    CHECK(ahead(q).z == test::near(-1.0f));
    CHECK(right(q).y == test::near(0.5f));
}

TEST_CASE("camera path: keys out of order are harmless") {
    CameraPath path = path_through({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {5, 5, 1});
    for (const bool loop : {false, true}) {
        path.loop = loop;
        for (double t = -1; t < 8; t += 0.5) {
            const CameraPose pose = camera_pose(path, t);
            CHECK(std::isfinite(pose.position.x));
            CHECK(std::isfinite(pose.rotation.w));
        }
    }
}

TEST_CASE(
    "camera path: interpolated rotations are made upright without changing the view direction"
    * technique("anim.camera-upright")) {
    // anim.camera-upright: halfway from rest to yaw 90 times pitch 60 the camera rolls.
    const Quat end = glm::angleAxis(radians(90.0f), Vec3(0, 1, 0))
                     * glm::angleAxis(radians(60.0f), Vec3(1, 0, 0));
    const Quat half = glm::slerp(Quat(1, 0, 0, 0), end, 0.5f);
    CHECK(right(half).y == test::near(-0.219275f).epsilon(1e-4));
    const Quat level = upright_rotation(half);
    CHECK(std::abs(right(level).y) < 1e-6f);
    CHECK(glm::length(ahead(level) - ahead(half)) < 1e-6f);
    const Quat twice = upright_rotation(level);
    CHECK(std::abs(glm::dot(twice, level)) == test::near(1.0f));
    for (const float pitch : {90.0f, -90.0f}) {
        const Quat vertical = upright_rotation(glm::angleAxis(radians(pitch), Vec3(1, 0, 0)));
        CHECK(std::isfinite(vertical.w));
        CHECK(glm::length(ahead(vertical) - Vec3(0, pitch / 90.0f, 0)) < 1e-5f);
    }
    CameraPath path = walk();
    path.aim = CameraAim::Rotation;
    path.keys[0].rotation = Quat(1, 0, 0, 0);
    path.keys[1].rotation = end;
    CHECK(std::abs(right(camera_pose(path, 1).rotation).y) < 1e-6f);
    for (CameraKey& key : path.keys) {
        key.roll = radians(30.0f);
    }
    CHECK(
        right(camera_pose(path, 1).rotation).y
        == test::near(0.5f * std::sqrt(1.0f - square(ahead(half).y))).epsilon(1e-3));
    for (CameraKey& key : path.keys) {
        key.roll = 0.0f;
    }
    path.upright = false;
    CHECK(right(camera_pose(path, 1).rotation).y == test::near(-0.219275f).epsilon(1e-4));
}

TEST_CASE(
    "camera path: looking along a direction is exact for vertical and missing ones"
    * technique("anim.camera-upright")) {
    for (const Vec3 d : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(1e-9f, -1, 0), Vec3(3, 4, -5)}) {
        const Quat q = look_along(d);
        CHECK(glm::length(ahead(q) - glm::normalize(d)) < 1e-5f);
        CHECK(std::abs(right(q).y) < 1e-5f);
    }
    CHECK(ahead(look_along({0, 0, 0})).z == test::near(-1.0f));
}
