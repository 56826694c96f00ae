#include "ecs/world.h"
#include "systems/env_probe_system.h"
#include "systems/update_world.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace limn::env_probe_test {
namespace {

/// How many faces are due in each frame of a probe that moves along x.
std::vector<int> due_faces(const EnvProbe& probe, float speed, int frames) {
    EnvProbeState state;
    std::vector<int> due;
    for (int i = 0; i < frames; ++i) {
        const std::uint64_t before = state.faces;
        step_env_probe(probe, {speed * static_cast<float>(i) / 60.0f, 0, 0}, state);
        due.push_back(static_cast<int>(state.faces - before));
    }
    return due;
}

int count_updates(const std::vector<int>& due) {
    return static_cast<int>(std::count(due.begin(), due.end(), 6));
}

}  // namespace

TEST_CASE("env_probe: one that stands still looks around once" * technique("env.update-policy")) {
    const auto due = due_faces({.update = ProbeUpdate::Movement, .threshold = 0}, 0, 500);
    CHECK(due[0] == 6);
    CHECK(count_updates(due) == 1);
    CHECK(count_updates(due_faces({.update = ProbeUpdate::Once}, 5, 500)) == 1);
}

TEST_CASE(
    "env_probe: at 1 m/s a threshold of 0.25 m is passed every 16th of 60 frames a second, "
    "37 times in 10 s"
    * technique("env.update-policy")) {
    const auto due = due_faces({.update = ProbeUpdate::Movement, .threshold = 0.25f}, 1.0f, 600);
    for (int i = 0; i < 600; ++i) {
        CAPTURE(i);
        CHECK(due[i] == (i % 16 == 0 ? 6 : 0));
    }
    CHECK(count_updates(due) == 1 + 37);  // the first is no movement
}

TEST_CASE(
    "env_probe: a period of 4 frames is a quarter of them, the first among them"
    * technique("env.update-policy")) {
    const auto due = due_faces({.update = ProbeUpdate::Period, .period = 4}, 100, 400);
    CHECK(due[0] == 6);
    CHECK(count_updates(due) == 100);
    CHECK(count_updates(due_faces({.update = ProbeUpdate::Period, .period = 1}, 0, 50)) == 50);
}

TEST_CASE("env_probe: of either, what comes first counts") {
    const EnvProbe probe = {.update = ProbeUpdate::Either, .period = 10, .threshold = 0.25f};
    CHECK(count_updates(due_faces(probe, 0, 100)) == 10);
    CHECK(count_updates(due_faces(probe, 3, 96)) == 16);  // every 6th
}

TEST_CASE(
    "env_probe: face by face a round takes six frames, the first time one"
    * technique("env.update-policy")) {
    const auto due =
        due_faces({.update = ProbeUpdate::Period, .period = 10, .face_by_face = true}, 0, 30);
    for (int i = 0; i < 30; ++i) {
        CAPTURE(i);
        CHECK(due[i] == (i == 0 ? 6 : i >= 10 && i % 10 < 6 ? 1 : 0));
    }
}

TEST_CASE("env_probe: in a world it gets its state before the first frame and follows its entity") {
    World world;
    const Entity probe = world.create(
        EnvProbe{.update = ProbeUpdate::Movement, .threshold = 0.5f},
        Transform{.position = {1, 0, 0}});
    start_world(world);
    REQUIRE(world.find<EnvProbeState>(probe) != nullptr);
    CHECK(world.get<EnvProbeState>(probe).faces == 6);
    CHECK(world.get<EnvProbeState>(probe).capture_position == Vec3(1, 0, 0));
    Schedule schedule = make_world_schedule();
    step_world(world, schedule);
    CHECK(world.get<EnvProbeState>(probe).faces == 6);
    world.get<Transform>(probe).position = {3, 0, 0};
    step_world(world, schedule);
    CHECK(world.get<EnvProbeState>(probe).faces == 12);
    CHECK(world.get<EnvProbeState>(probe).capture_position == Vec3(3, 0, 0));
}

}  // namespace limn::env_probe_test
