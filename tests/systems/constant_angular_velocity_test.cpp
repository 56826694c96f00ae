#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/constant_angular_velocity.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace limn::constant_angular_velocity_test {
namespace {

Quat about_z(float angle) {
    return rotation_about({0, 0, 1}, radians(angle));
}

Quat rotation_at(const TimedRotations& turns, float time) {
    const KeyInterval place = find_keys(turns.times, time);
    return slerp_along(turns.rotations[place.first], turns.rotations[place.first + 1], place.u);
}

}  // namespace

TEST_CASE(
    "even turns: keys at 0, 10, 40 and 90 degrees are at 0, 1, 4 and 9 seconds"
    * technique("anim.constant-angular-velocity")) {
    const std::vector<Quat> keys = {about_z(0), about_z(10), -about_z(40), about_z(90)};
    const TimedRotations turns = make_constant_speed(keys, 9);
    REQUIRE(turns.times.size() == 4);
    const float expected[] = {0, 1, 4, 9};
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(turns.times[i] == test::near(expected[i]).epsilon(1e-5));
    }
    for (int i = 0; i <= 90; ++i) {
        const float time = 0.1f * static_cast<float>(i);
        const AxisAngle turned =
            axis_angle(to_same_hemisphere(Quat(1, 0, 0, 0), rotation_at(turns, time)));
        CHECK(degrees(turned.angle) == test::near(10 * time).epsilon(1e-4));
    }
}

TEST_CASE(
    "even turns: between any keys the angular speed is the same"
    * technique("anim.constant-angular-velocity")) {
    Random random(3, 0, 0, 0);
    std::vector<Quat> keys;
    for (int i = 0; i < 12; ++i) {
        keys.push_back(rotation_about(random.direction(), random.uniform(0.2f, 6.0f)));
    }
    const TimedRotations turns = make_constant_speed(keys, 7);
    CHECK(turns.times.back() == 7);
    double speed = -1;
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        const Quat way = glm::conjugate(turns.rotations[i]) * turns.rotations[i + 1];
        const float seconds = turns.times[i + 1] - turns.times[i];
        const double found = static_cast<double>(axis_angle(way).angle / seconds);
        speed = speed < 0 ? found : speed;
        CHECK(found == test::near(speed).epsilon(1e-3));
    }
}

TEST_CASE(
    "even turns: whole frames sum to the total, distributed as evenly as possible"
    * technique("anim.constant-angular-velocity")) {
    const std::vector<Quat> keys = {about_z(0), about_z(10), about_z(40), about_z(90)};
    CHECK(distribute_frames(keys, 9) == std::vector<int>{1, 3, 5});
    CHECK(distribute_frames(keys, 10) == std::vector<int>{1, 3, 6});  // of 1.1, 3.3 and 5.6
    for (int frames = 0; frames < 50; ++frames) {
        const std::vector<int> counts = distribute_frames(keys, frames);
        CHECK(std::accumulate(counts.begin(), counts.end(), 0) == frames);
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(std::abs(counts[i] - frames * (1.0 + 2.0 * static_cast<double>(i)) / 9) < 1);
        }
    }
}

TEST_CASE(
    "even turns: keys without rotation are dropped, a single one stays, none give none"
    * technique("anim.constant-angular-velocity")) {
    const TimedRotations turns =
        make_constant_speed(std::vector<Quat>{about_z(5), about_z(5), -about_z(5), about_z(65)}, 2);
    CHECK(turns.times == std::vector<float>{0, 2});
    CHECK(turns.rotations.size() == 2);
    const TimedRotations one = make_constant_speed(std::vector<Quat>(3, about_z(20)), 2);
    CHECK(one.times == std::vector<float>{0});
    CHECK(one.rotations.size() == 1);
    CHECK(make_constant_speed({}, 2).times.empty());
    CHECK(distribute_frames({}, 5).empty());
    CHECK(distribute_frames(std::vector<Quat>(3, about_z(20)), 5) == std::vector<int>{3, 2});
}

}  // namespace limn::constant_angular_velocity_test
