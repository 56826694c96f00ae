#include "ecs/components/all.h"
#include "ecs/components/key_track.h"
#include "ecs/components/light.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "systems/animation/key_track_system.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace limn::key_track_test {

using test::near;

namespace {

FieldTrack radius_track(TrackWrap wrap) {
    return {.field = "point_light.radius", .wrap = wrap, .times = {1, 2, 4}, .values = {3, 5, 4}};
}

float number_at(const FieldTrack& track, double time) {
    return track_value(track, FieldType::Float, time).x;
}

std::string reason(const FieldTrack& track) {
    register_all_components();
    const Result<TrackTarget> target = find_track_target(track);
    return target ? std::string("none") : target.error().message;
}

Quat to_quat(const Vec4& v) {
    return {v.w, v.x, v.y, v.z};
}

void append(std::vector<float>& values, const Quat& q) {
    values.insert(values.end(), {q.x, q.y, q.z, q.w});
}

}  // namespace

TEST_CASE("key_track: floats of a key by type and mode" * technique("anim.key-track")) {
    CHECK(floats_per_key(FieldType::Float, TrackMode::Linear) == 1);
    CHECK(floats_per_key(FieldType::Float, TrackMode::Bezier) == 3);
    CHECK(floats_per_key(FieldType::Vec3, TrackMode::Linear) == 3);
    CHECK(floats_per_key(FieldType::Vec3, TrackMode::Bezier) == 9);
    CHECK(floats_per_key(FieldType::Quat, TrackMode::Slerp) == 4);
    CHECK(floats_per_key(FieldType::Quat, TrackMode::Linear) == 4);
    CHECK(floats_per_key(FieldType::Quat, TrackMode::Squad) == 12);
    CHECK(floats_per_key(FieldType::Quat, TrackMode::Bezier) == 0);
    CHECK(floats_per_key(FieldType::Vec3, TrackMode::Squad) == 0);
    CHECK(floats_per_key(FieldType::Bool, TrackMode::Linear) == 0);
}

TEST_CASE(
    "key_track: at a key the value is the key, one key holds for all times"
    * technique("anim.key-track")) {
    for (const TrackWrap wrap : {TrackWrap::Clamp, TrackWrap::PingPong}) {
        const FieldTrack track = radius_track(wrap);
        for (std::size_t i = 0; i < track.times.size(); ++i) {
            CHECK(number_at(track, track.times[i]) == track.values[i]);
        }
    }
    const FieldTrack loop = radius_track(TrackWrap::Loop);
    CHECK(number_at(loop, 1) == 3);
    CHECK(number_at(loop, 2) == 5);
    const FieldTrack single = {.field = "point_light.radius", .times = {2}, .values = {7}};
    for (const double time : {-1.0, 0.0, 2.0, 1e6}) {
        CHECK(number_at(single, time) == 7);
    }
    FieldTrack curve = {
        .field = "transform.position",
        .mode = TrackMode::Bezier,
        .times = {0, 1},
        .values = {0, 0, 0, 0, 0, 0, 0, 3, 0, 1, 2, 3, 1, 5, 3, 1, 2, 3}};
    CHECK(track_value(curve, FieldType::Vec3, 0) == Vec4(0));
    CHECK(track_value(curve, FieldType::Vec3, 1) == Vec4(1, 2, 3, 0));
    // (p0 + 3 p1 + 3 p2 + p3) / 8.
    const Vec4 middle = track_value(curve, FieldType::Vec3, 0.5);
    CHECK(glm::length(middle - Vec4(0.5f, (9 + 15 + 2) / 8.0f, 1.5f, 0)) < 1e-6f);
}

TEST_CASE("key_track: tracks are clamped, loop or swing between their ends") {
    const FieldTrack clamp = radius_track(TrackWrap::Clamp);
    CHECK(number_at(clamp, 0) == 3);
    CHECK(number_at(clamp, 1.5) == near(4));
    CHECK(number_at(clamp, 3) == near(4.5));
    CHECK(number_at(clamp, 99) == 4);
    const FieldTrack loop = radius_track(TrackWrap::Loop);
    for (const double time : {1.25, 1.5, 3.0}) {
        CHECK(number_at(loop, time + 30) == near(static_cast<double>(number_at(loop, time))));
        CHECK(number_at(loop, time - 3) == near(static_cast<double>(number_at(loop, time))));
    }
    const FieldTrack swing = radius_track(TrackWrap::PingPong);
    for (const double after : {0.1, 0.7, 1.9, 2.5}) {
        CHECK(
            number_at(swing, 4 + after) == near(static_cast<double>(number_at(swing, 4 - after))));
        CHECK(
            number_at(swing, 7 + after) == near(static_cast<double>(number_at(swing, 1 + after))));
    }
}

TEST_CASE("key_track: rotations follow great arcs, or squad's curve through inner points") {
    const Quat keys[] = {Quat(1, 0, 0, 0), glm::angleAxis(1.2f, Vec3(0, 1, 0))};
    FieldTrack track = {.field = "transform.rotation", .mode = TrackMode::Slerp, .times = {0, 2}};
    append(track.values, keys[0]);
    append(track.values, -keys[1]);  // the same rotation
    for (const float time : {0.0f, 0.5f, 1.3f, 2.0f}) {
        const Quat q = to_quat(track_value(track, FieldType::Quat, time));
        const Quat exact = glm::angleAxis(0.6f * time, Vec3(0, 1, 0));
        CHECK(std::abs(glm::dot(q, exact)) == near(1).epsilon(1e-6));
    }
    // With the keys themselves as inner points: slower at both ends than slerp, equal halfway.
    FieldTrack smooth = {.field = "transform.rotation", .mode = TrackMode::Squad, .times = {0, 2}};
    for (const Quat& key : keys) {
        for (int i = 0; i < 3; ++i) {
            append(smooth.values, key);
        }
    }
    const Quat middle = to_quat(track_value(smooth, FieldType::Quat, 1));
    CHECK(glm::dot(middle, glm::angleAxis(0.6f, Vec3(0, 1, 0))) == near(1).epsilon(1e-6));
    // An inner point off the arc bends the way between.
    smooth.values[8] += 0.5f;
    const Quat bent = to_quat(track_value(smooth, FieldType::Quat, 1));
    CHECK(std::abs(bent.x) > 0.01f);
    CHECK(glm::length(bent) == near(1).epsilon(1e-6));
    // So does the one before the second key; that after it is for what follows.
    smooth.values[12 + 6] += 0.5f;
    const Quat twice = to_quat(track_value(smooth, FieldType::Quat, 1));
    CHECK(std::abs(twice.z - bent.z) > 0.01f);
    smooth.values[12 + 10] += 0.5f;
    CHECK(to_quat(track_value(smooth, FieldType::Quat, 1)) == twice);
}

TEST_CASE(
    "key_track: bad tracks are refused with the index of the key" * technique("anim.key-track")) {
    FieldTrack track = radius_track(TrackWrap::Clamp);
    CHECK(reason(track) == "none");
    track.times = {1, 4, 4};
    CHECK(reason(track).find("found 4 s at key 2") != std::string::npos);
    track.times = {1, 4, 2};
    CHECK(reason(track).find("found 2 s at key 2") != std::string::npos);
    track = radius_track(TrackWrap::Clamp);
    track.values[1] = std::numeric_limits<float>::quiet_NaN();
    CHECK(reason(track).find("not finite at key 1") != std::string::npos);
    track.values.pop_back();
    CHECK(reason(track).find("found 2 values, expected 1 for each of 3 keys") != std::string::npos);
    track.field = "point_light.radios";
    CHECK(reason(track).find("point_light.radios") != std::string::npos);
    track.field = "nothing";
    CHECK(reason(track) != "none");
    track = radius_track(TrackWrap::Clamp);
    track.mode = TrackMode::Squad;
    CHECK(reason(track).find("cannot animate") != std::string::npos);
    CHECK(reason({.field = "point_light.radius"}) == "none");  // no keys
}

TEST_CASE("key_track: numbers, colors and rotations of an entity are animated, nothing else") {
    register_all_components();
    World world;
    const Quat turned = glm::angleAxis(1.0f, Vec3(0, 0, 1));
    KeyTrack tracks;
    tracks.tracks.push_back(radius_track(TrackWrap::Clamp));
    tracks.tracks.push_back(
        {.field = "point_light.color", .times = {0, 1}, .values = {1, 0, 0, 0, 0, 1}});
    FieldTrack turn = {.field = "transform.rotation", .mode = TrackMode::Slerp, .times = {0, 1}};
    append(turn.values, Quat(1, 0, 0, 0));
    append(turn.values, turned);
    tracks.tracks.push_back(turn);
    tracks.tracks.push_back({.field = "transform.position"});  // no keys: untouched
    tracks.tracks.push_back(
        {.field = "spot_light.radius", .times = {0}, .values = {9}});  // has none
    const Entity lamp = world.create(
        Transform{.position = {1, 2, 3}}, PointLight{.intensity = 7}, std::move(tracks));
    world.insert_resource(FrameTime{.step = 0.5f});
    Schedule schedule = make_world_schedule();
    start_world(world);
    step_world(world, schedule);
    CHECK(world.get<const PointLight>(lamp).color == Vec3(0.5f, 0, 0.5f));
    CHECK(world.get<const PointLight>(lamp).radius == 3);
    step_world(world, schedule);
    step_world(world, schedule);
    CHECK(world.get<const PointLight>(lamp).radius == near(4));
    CHECK(world.get<const PointLight>(lamp).intensity == 7);
    CHECK(world.get<const Transform>(lamp).position == Vec3(1, 2, 3));
    CHECK(glm::dot(world.get<const Transform>(lamp).rotation, turned) == near(1).epsilon(1e-6));
    CHECK_FALSE(world.has<SpotLight>(lamp));
    // Edited while it plays.
    world.get<KeyTrack>(lamp).tracks[0].values = {8, 8, 8};
    step_world(world, schedule);
    CHECK(world.get<const PointLight>(lamp).radius == 8);
}

}  // namespace limn::key_track_test
