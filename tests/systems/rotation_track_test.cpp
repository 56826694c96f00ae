#include "ecs/base/rotation.h"
#include "ecs/world.h"
#include "systems/animation/rotation_track_system.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace limn::rotation_track_test {
namespace {

Quat yaw(float degrees) {
    return glm::angleAxis(radians(degrees), Vec3(0, 1, 0));
}

/// Keys of 0, 10, 40 and 90 degrees about y, a second apart.
RotationTrack uneven_track(RotationMethod method, RotationTiming timing = RotationTiming::Keys) {
    return {
        .keys = {{0, yaw(0)}, {1, yaw(10)}, {2, yaw(40)}, {3, yaw(90)}},
        .method = method,
        .timing = timing};
}

float degrees_at(const RotationTrack& track, double time) {
    const AxisAngle turn = axis_angle(rotation_at(track, make_rotation_track(track), time));
    return glm::degrees(turn.angle) * (turn.axis.y < 0 ? -1.0f : 1.0f);
}

}  // namespace

TEST_CASE("rotation_track: every method is at its keys at their times" * technique("anim.slerp")) {
    for (const RotationMethod method :
         {RotationMethod::Slerp, RotationMethod::Nlerp, RotationMethod::Squad,
          RotationMethod::Euler}) {
        const RotationTrack track = uneven_track(method);
        const float keys[] = {0, 10, 40, 90};
        for (int i = 0; i < 4; ++i) {
            CAPTURE(static_cast<int>(method));
            CHECK(degrees_at(track, i) == test::near(keys[i]).scale(1).epsilon(1e-4));
        }
        CHECK(degrees_at(track, -1) == test::near(0).scale(1).epsilon(1e-4));
        CHECK(degrees_at(track, 9) == test::near(90).epsilon(1e-5));
    }
}

TEST_CASE(
    "rotation_track: slerp has constant speed between keys, nlerp lags, squad has no corner"
    * technique("anim.quat-lerp, anim.squad")) {
    const RotationTrack turn = {.keys = {{0, yaw(0)}, {1, yaw(160)}}};
    CHECK(degrees_at(turn, 0.25) == test::near(40).epsilon(1e-5));
    RotationTrack straight = turn;
    straight.method = RotationMethod::Nlerp;
    // tan(angle / 4 of 160) = (u sin 80) / (1 - u + u cos 80) with half angles.
    const double u = 0.25;
    const double half = 80 * M_PI / 180;
    const double expected =
        2 * std::atan2(u * std::sin(half), 1 - u + u * std::cos(half)) * 180 / M_PI;
    CHECK(degrees_at(straight, u) == test::near(expected).epsilon(1e-5));
    CHECK(expected < 35);  // where slerp is at 40

    const auto speed = [](const RotationTrack& track, double time) {
        return (degrees_at(track, time + 1e-2) - degrees_at(track, time)) / 1e-2f;
    };
    const RotationTrack corner = uneven_track(RotationMethod::Slerp);
    const RotationTrack smooth = uneven_track(RotationMethod::Squad);
    CHECK(speed(corner, 1) - speed(corner, 0.99) == test::near(20).epsilon(0.02));
    CHECK(std::abs(speed(smooth, 1) - speed(smooth, 0.99)) < 1.0f);
}

TEST_CASE(
    "rotation_track: at constant speed the times of keys follow the angles"
    * technique("anim.constant-angular-velocity")) {
    const RotationTrack track = uneven_track(RotationMethod::Slerp, RotationTiming::EvenSpeed);
    for (const double time : {0.0, 0.5, 1.0, 1.7, 2.4, 3.0}) {
        CHECK(degrees_at(track, time) == test::near(30 * time).scale(1).epsilon(1e-4));
    }
}

TEST_CASE(
    "rotation_track: Euler angles take a path that is no great arc" * technique("anim.euler")) {
    // From a yaw of 90 degrees to a pitch of 90: halfway 45 and 45 degrees.
    RotationTrack track = {
        .keys = {{0, yaw(90)}, {1, glm::angleAxis(radians(90.0f), Vec3(1, 0, 0))}},
        .method = RotationMethod::Euler};
    const Quat middle = rotation_at(track, make_rotation_track(track), 0.5);
    const Quat expected = yaw(45) * glm::angleAxis(radians(45.0f), Vec3(1, 0, 0));
    CHECK(std::abs(glm::dot(middle, expected)) == test::near(1).epsilon(1e-5));
    track.method = RotationMethod::Slerp;
    const Quat arc = rotation_at(track, make_rotation_track(track), 0.5);
    CHECK(std::abs(glm::dot(arc, expected)) < 0.99f);
}

TEST_CASE(
    "rotation_track: the sign of a key does not matter, the shorter arc is taken"
    * technique("anim.shortest-arc")) {
    RotationTrack track = {.keys = {{0, yaw(0)}, {1, -yaw(90)}, {2, yaw(200)}}};
    CHECK(degrees_at(track, 0.5) == test::near(45).epsilon(1e-5));
    CHECK(degrees_at(track, 1.5) == test::near(145).epsilon(1e-5));
}

TEST_CASE("rotation_track: in a world it moves the entity, follows changes and starts over") {
    World world;
    world.insert_resource(FrameTime{.step = 0.25f});
    RotationTrack track = uneven_track(RotationMethod::Slerp);
    track.loop = true;
    const Entity entity = world.create(Transform{}, track);
    const Entity bare = world.create(Transform{.rotation = yaw(33)}, RotationTrack{});
    Schedule schedule = make_world_schedule();
    start_world(world);
    const auto turned = [&] {
        return glm::degrees(axis_angle(std::as_const(world).get<Transform>(entity).rotation).angle);
    };
    for (int i = 0; i < 6; ++i) {
        step_world(world, schedule);
    }
    CHECK(turned() == test::near(25).epsilon(1e-4));  // at 1.5 s
    for (int i = 0; i < 12; ++i) {
        step_world(world, schedule);
    }
    CHECK(turned() == test::near(25).epsilon(1e-4));  // and 3 s later
    world.get<RotationTrack>(entity).keys[2].rotation = yaw(110);
    step_world(world, schedule);  // at 1.75 s
    CHECK(turned() == test::near(85).epsilon(1e-4));
    CHECK(
        std::abs(glm::dot(std::as_const(world).get<Transform>(bare).rotation, yaw(33)))
        == test::near(1));
}

}  // namespace limn::rotation_track_test
