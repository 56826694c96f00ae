// How a character looks that a motor moves: it runs, jumps, lands, swims, pushes and carries.

#include "ecs/base/jobs.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/motion_match.h"
#include "ecs/snapshot.h"
#include "systems/animation/walk/apply_motor_pose.h"
#include "tests/near.h"
#include "tests/systems/hero_fixture.h"
#include "tests/systems/walk_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace limn::motor_pose_test {

using namespace limn::test;

namespace {

constexpr float kFrame = 1.0f / 60;

/// Deepest that the hips sink after a fall from this height, and how low they are 1.5 s later.
std::array<float, 2> sink_after_fall(float height) {
    PoseStage stage({}, {.position = {0, height, 0}});
    REQUIRE(stage.run_to_landing());
    float deepest = 0;
    for (int i = 0; i < 90; ++i) {
        deepest = std::max(deepest, 0.95f - stage.hips_height());
        stage.step();
    }
    return {deepest, 0.95f - stage.hips_height()};
}

/// Runs at `speed` and checks each frame.
template <typename Check>
void run_straight(float speed, int frames, Check&& check) {
    Walk walk;
    walk.moves_root = false;
    WalkTrial trial(walk);
    float now = 0;
    for (int i = 0; i < frames; ++i) {
        now = std::min(now + 8 * kFrame, speed);
        trial.transform.position.z += now * kFrame;
        trial.step(kFrame);
        check(trial, i);
    }
}

bool flies(const WalkTrial& trial, std::uint32_t foot) {
    return flight_progress(trial.state, foot) < 1;
}

}  // namespace

TEST_CASE("run: above the speed of walks both feet fly at times, below never") {
    for (const float speed : {1.4f, 2.0f, 4.2f}) {
        int both = 0;
        int none = 0;
        run_straight(speed, 300, [&](const WalkTrial& trial, int i) {
            both += i > 120 && flies(trial, 0) && flies(trial, 1) ? 1 : 0;
            none += i > 120 && !flies(trial, 0) && !flies(trial, 1) ? 1 : 0;
        });
        CAPTURE(speed);
        CHECK((both > 30) == (speed > 3));
        CHECK((none > 15) == (speed < 3));
    }
}

TEST_CASE(
    "run: feet on the ground do not slide, none is below it, and knees bend forward"
    * technique("char.walk-cycle")) {
    float slide = 0;
    float lowest = 0;
    float least_bend = 1;
    std::array<Vec3, 2> toes{};
    std::array<int, 2> planted{};
    run_straight(4.2f, 400, [&](const WalkTrial& trial, int frame) {
        for (std::uint32_t i = 0; i < 2; ++i) {
            const bool rolls = trial.state.feet[i].pitch > 0;  // about its heel
            planted[i] = flies(trial, i) || rolls ? 0 : planted[i] + 1;
            toes[i] = planted[i] == 1 ? trial.toe(i) : toes[i];
            const bool is_steady = frame > 120;  // strides catch up while it gains speed
            const float moved = glm::distance(toes[i], trial.toe(i));
            slide = std::max(slide, is_steady && planted[i] > 0 ? moved : 0.0f);
            lowest = std::min(lowest, trial.clearance(i));
            least_bend = std::min(least_bend, trial.knee(i));
        }
    });
    CHECK(slide < 0.002f);
    CHECK(lowest > -0.002f);
    CHECK(least_bend > -1e-4f);
}

TEST_CASE("run: hips rise and fall twice a cycle, and joints have no jumps of speed") {
    std::vector<float> heights;
    run_straight(4.2f, 360, [&](const WalkTrial& trial, int) {
        heights.push_back(trial.place(trial.body.hips).position.y);
    });
    heights.erase(heights.begin(), heights.begin() + 150);
    float fastest_change = 0;
    float sum = 0;
    for (std::size_t i = 2; i < heights.size(); ++i) {
        const float change = heights[i] - 2 * heights[i - 1] + heights[i - 2];
        fastest_change = std::max(fastest_change, std::abs(change) / (kFrame * kFrame));
        sum += heights[i];
    }
    const float mean = sum / static_cast<float>(heights.size() - 2);
    int rises = 0;
    for (std::size_t i = 1; i < heights.size(); ++i) {
        rises += heights[i - 1] < mean && heights[i] >= mean ? 1 : 0;
    }
    CHECK(fastest_change < 60);  // m/s^2
    CHECK(rises >= 9);
    CHECK(rises <= 11);
}

TEST_CASE("motor pose: knees give way to landings by as much as they are hard, and recover") {
    float last = 0;
    for (const float height : {0.3f, 0.8f, 1.8f, 4.0f, 12.0f}) {
        const auto [deepest, later] = sink_after_fall(height);
        CAPTURE(height);
        CHECK(deepest > last + 0.01f);
        CHECK(deepest < 0.6f);
        CHECK(later < 0.03f);
        last = deepest;
    }
}

TEST_CASE("motor pose: crouches before it jumps, rises, and lands on both feet") {
    PoseStage stage;
    const float stand = stage.hips_height();
    stage.jump();
    float crouch = stand;
    int waited = 0;
    while (stage.state().mode == MotorMode::Stand && waited < 30) {
        stage.step();
        crouch = std::min(crouch, stage.hips_height());
        ++waited;
    }
    CHECK(waited >= 6);
    CHECK(waited <= 8);
    CHECK(crouch < stand - 0.08f);
    float highest = 0;
    while (stage.motion().off_ground != 0) {
        highest = std::max(highest, stage.joint(stage.body().legs[0].foot).y);
        stage.step();
    }
    CHECK(highest > 0.9f);
    CHECK(std::abs(stage.walk().feet[0].place.y) < 1e-4f);
    CHECK(std::abs(stage.walk().feet[1].place.y) < 1e-4f);
}

TEST_CASE("motor pose: feet stay where they have landed until they step") {
    PoseStage stage;
    stage.go({0, 0, 1.2f});
    stage.step(60);
    stage.jump();
    stage.step(10);
    stage.go(Vec3(0));
    REQUIRE(stage.run_to_landing());
    std::array<Vec3, 2> prints = {stage.walk().feet[0].place, stage.walk().feet[1].place};
    float slide = 0;
    for (int i = 0; i < 60; ++i) {
        stage.step();
        for (std::uint32_t k = 0; k < 2; ++k) {
            const bool steps = flight_progress(stage.walk(), k) < 1;
            prints[k] = steps ? stage.walk().feet[k].place : prints[k];
            if (!steps) {
                const Vec3 off = stage.walk().feet[k].place - prints[k];
                slide = std::max(slide, glm::length(Vec3(off.x, 0, off.z)));
                prints[k] = stage.walk().feet[k].place;
            }
        }
    }
    CHECK(slide < 0.002f);
}

TEST_CASE(
    "motor pose: a jump rises as its take-off says, from a crouch, and soles clear the ground") {
    for (const float speed : {0.0f, 1.4f, 4.2f}) {
        CAPTURE(speed);
        PoseStage stage;
        stage.go({0, 0, speed});
        stage.step(200);
        stage.jump();
        float lowest_hips = 1;
        float take_off = 0;
        float apex = 0;
        float drawn_up = 0;
        float lowest = 1;
        float before_landing = 1;
        for (int i = 0; i < 100 && (apex < 0.1f || stage.state().mode == MotorMode::Fall); ++i) {
            stage.step();
            const bool flies = stage.state().mode == MotorMode::Fall;
            lowest_hips = flies ? lowest_hips : std::min(lowest_hips, stage.hips_height());
            take_off = flies && take_off == 0 ? stage.state().velocity.y : take_off;
            if (flies) {
                drawn_up = stage.feet().y > apex ? stage.clearance() - stage.feet().y : drawn_up;
                apex = std::max(apex, stage.feet().y);
                lowest = std::min(lowest, stage.clearance());
                before_landing =
                    stage.state().velocity.y < 0 && stage.feet().y > 0.3f * kHeroMotor.jump
                        ? std::min(before_landing, stage.clearance())
                        : before_landing;
            }
        }
        CHECK(lowest_hips < 0.92f);
        CHECK(lowest_hips > 0.72f);
        // Half a step of gravity is taken off at once.
        CHECK(
            double(take_off) + 0.5 * 9.81 / 60
            == near(std::sqrt(2 * 9.81 * double(kHeroMotor.jump))).epsilon(1e-3));
        CHECK(double(apex) == near(double(kHeroMotor.jump)).epsilon(0.01));
        CHECK(drawn_up > 0.1f);
        CHECK(lowest > -1e-3f);
        CHECK(before_landing > 0.2f);
    }
}

TEST_CASE("motor pose: joints do not jump at take-off, in the air and at the landing") {
    PoseStage stage;
    stage.go({0, 0, 3.5f});
    stage.step(90);
    stage.jump();
    const std::array<std::uint16_t, 7> joints = {
        stage.body().hips,         stage.body().head,         stage.body().legs[0].foot,
        stage.body().legs[1].foot, stage.body().arms[0].hand, stage.body().arms[1].hand,
        stage.body().legs[0].shin};
    std::array<Vec3, 7> last{};
    float fastest = 0;
    for (int i = 0; i < 120; ++i) {
        for (std::size_t k = 0; k < joints.size(); ++k) {
            const Vec3 now = stage.joint(joints[k]) - stage.feet();
            const float speed = i > 0 ? glm::distance(now, last[k]) / kFrame : 0.0f;
            fastest = std::max(fastest, speed);
            last[k] = now;
        }
        stage.step();
    }
    CHECK(fastest < 14);  // m/s relative to the root
}

TEST_CASE("motor pose: hands hold what is carried, and lean on what is pushed") {
    PoseStage stage;
    const Entity ball =
        stage.world.create(Transform{.position = {0, 0.3f, 0.8f}}, LooseBody{.radius = 0.2f});
    stage.step(2);
    stage.world.get<LooseState>(ball).carrier = stage.person;
    stage.step(60);
    const Vec3 center = stage.world.get<const Transform>(ball).position;
    for (const WalkArm& arm : stage.body().arms) {
        const float distance = glm::distance(stage.joint(arm.hand), center);
        CHECK(distance > 0.15f);
        CHECK(distance < 0.32f);
    }
    stage.world.get<LooseState>(ball).carrier = Entity{};
    stage.step(1);
    CHECK(stage.motion().holds == 0);
    stage.step(8);
    CHECK(stage.motion().fling.value > 0.5f);

    PoseStage pusher;
    pusher.world.create(
        Transform{.position = {0, 0.5f, 1.2f}},
        LooseBody{.radius = 0.5f, .mass = 40, .bounce = 0, .rolls = false});
    pusher.go({0, 0, 0.8f});
    pusher.step(90);
    CHECK(pusher.motion().push.value > 0.9f);
    CHECK(pusher.joint(pusher.body().arms[0].hand).z > pusher.feet().z + 0.1f);
    pusher.go(Vec3(0));
    pusher.step(60);
    CHECK(pusher.motion().push.value < 0.05f);
}

TEST_CASE("motor pose: stoops for what it picks up from the ground, and stands up with it") {
    PoseStage stage;
    const Entity ball =
        stage.world.create(Transform{.position = {0, 0.2f, 0.8f}}, LooseBody{.radius = 0.2f});
    stage.step(2);
    const float upright = stage.joint(stage.body().head).y;
    stage.world.get<LooseState>(ball).carrier = stage.person;
    float lowest = upright;
    float nearest = 1;
    float jump = 0;
    std::array<Vec3, 3> heads{};
    for (int i = 0; i < 90; ++i) {
        stage.step();
        std::rotate(heads.begin(), heads.begin() + 2, heads.end());
        heads[0] = stage.joint(stage.body().head);
        jump = std::max(jump, i < 3 ? 0.0f : glm::distance(heads[0] + heads[2], 2.0f * heads[1]));
        lowest = std::min(lowest, heads[0].y);
        const Vec3 hand = stage.joint(stage.body().arms[0].hand);
        const float away = glm::distance(hand, stage.world.get<const Transform>(ball).position);
        nearest = std::min(nearest, i < 24 ? away : 1.0f);
    }
    CHECK(lowest < upright - 0.25f);
    CHECK(nearest < 0.4f);
    CHECK(jump < 0.03f);
    CHECK(heads[0].y > upright - 0.06f);
}

TEST_CASE("motor pose: feet stand on the steps of a stair, and none below who jumps") {
    PoseStage stage(
        {make_box_mesh({-1, 0, 0.8f}, {1, 0.15f, 3}), make_box_mesh({-1, 0, 1.3f}, {1, 0.3f, 3})});
    stage.world.add(stage.person, FootPlant{.step = 0.36f, .speed = 30});
    stage.go({0, 0, 1.2f});
    float largest = 0;
    for (int i = 0; i < 150; ++i) {
        stage.step();
        const auto& contacts = stage.world.get<const FootContacts>(stage.person);
        for (const float lift : contacts.lifts) {
            largest = std::max(largest, std::abs(lift));
        }
    }
    CHECK(largest > 0.05f);
    stage.jump();
    stage.step(25);
    REQUIRE(stage.state().mode == MotorMode::Fall);
    const auto& contacts = stage.world.get<const FootContacts>(stage.person);
    CHECK(std::max(std::abs(contacts.lifts[0]), std::abs(contacts.lifts[1])) < 1e-3f);
}

TEST_CASE("motor pose: lies in the water while it swims, and stands in it upright") {
    PoseStage stage;
    constexpr float kSurface = 2.5f;
    stage.world.create(Transform{.position = {0, kSurface, 0}}, Water{.size = {40, 40}});
    stage.step(240);
    REQUIRE(stage.state().mode == MotorMode::Swim);
    const auto trunk = [&] {
        return stage.joint(stage.body().head) - stage.joint(stage.body().hips);
    };
    CHECK(trunk().y > 0.4f);
    stage.go({0, 0, 1.1f});
    stage.step(240);
    CHECK(trunk().z > 0.4f);
    CHECK(trunk().y > 0.05f);
    CHECK(stage.joint(stage.body().head).y > kSurface - 0.1f);  // breathes
    const Affine& head = stage.world.get<const Pose>(stage.person).joints[stage.body().head];
    CHECK(transform_vector(head, {0, 0, 1}).y > -0.35f);  // looks ahead
    CHECK(stage.joint(stage.body().legs[0].foot).z < stage.joint(stage.body().hips).z - 0.3f);
}

TEST_CASE("motor pose: a snapshot in mid-jump continues with the same bits, on any threads") {
    std::vector<std::uint64_t> expected;
    for (const int threads : {1, 2, 3, 7}) {
        set_thread_count(threads);
        PoseStage stage;
        stage.go({0.5f, 0, 3});
        stage.step(60);
        stage.jump();
        stage.step(25);
        REQUIRE(stage.motion().off_ground == 1);
        const Result<std::vector<std::byte>> saved = save_snapshot(stage.world);
        REQUIRE(saved.ok());
        PoseStage again;
        REQUIRE(restore_snapshot(again.world, saved.value()).ok());
        std::vector<std::uint64_t> hashes;
        for (int i = 0; i < 90; ++i) {
            stage.step();
            again.step();
            hashes.push_back(state_hash(stage.world));
            REQUIRE(state_hash(again.world) == hashes.back());
        }
        expected = expected.empty() ? hashes : expected;
        CHECK(hashes == expected);
    }
    set_thread_count(0);
}

TEST_CASE("motor pose: long steps, none, and numbers that are not finite") {
    const SkeletonData person = make_stick_person();
    WalkBody body = find_walk_body(person);
    for (const float step : {0.0f, 1e-6f, 1.0f, 30.0f}) {
        WalkState walk;
        MotorPoseState state;
        Transform transform;
        place_walk({}, body, transform, walk);
        for (int i = 0; i < 20; ++i) {
            MotorPoseInput input;
            input.motor.mode = i % 3 == 0   ? MotorMode::Stand
                               : i % 3 == 1 ? MotorMode::Fall
                                            : MotorMode::Swim;
            input.velocity = {0, i % 2 == 0 ? -30.0f : 5.0f, i == 7 ? NAN : 4.0f};
            step_motor_pose({}, input, body, transform, step, state, walk);
            body.targets = find_walk_targets(body, walk, transform);
            add_motor_targets({}, state, body);
            LocalPose pose = person.rest;
            apply_walk(person, {}, walk, body, pose);
            apply_motor_pose(person, {}, state, body, pose);
            for (std::size_t j = 0; j < pose.size(); ++j) {
                REQUIRE(is_finite(pose.translations[j]));
                REQUIRE(std::isfinite(glm::length(pose.rotations[j])));
            }
        }
    }
    WalkBody legless;
    WalkState walk;
    MotorPoseState state;
    step_motor_pose({}, {}, legless, {}, kFrame, state, walk);
    LocalPose pose = person.rest;
    apply_motor_pose(person, {}, state, legless, pose);
    CHECK(pose.rotations == person.rest.rotations);
}

namespace {

/// Joints whose motion is looked at.
std::vector<std::uint16_t> shown_joints(const WalkBody& body) {
    std::vector<std::uint16_t> joints = {body.hips, body.head};
    for (std::size_t i = 0; i < 2; ++i) {
        joints.insert(
            joints.end(),
            {body.legs[i].shin, body.legs[i].foot, body.arms[i].fore, body.arms[i].hand});
    }
    return joints;
}

struct Smoothness {
    float fastest = 0;  ///< of joints, relative to the root [m/s]
    float jerk = 0;     ///< largest second difference of their places [m]
};

/// Jumps, and goes on for three seconds. `visit`: after each step, with whether it flies.
template <typename Visit>
Smoothness watch_jump(PoseStage& stage, Visit&& visit) {
    const std::vector<std::uint16_t> joints = shown_joints(stage.body());
    std::vector<std::array<Vec3, 3>> shown(joints.size());
    Smoothness found;
    stage.jump();
    for (int i = 0; i < 180; ++i) {
        stage.step();
        visit(stage.state().mode == MotorMode::Fall);
        for (std::size_t k = 0; k < joints.size(); ++k) {
            std::array<Vec3, 3>& last = shown[k];
            std::rotate(last.begin(), last.begin() + 2, last.end());
            last[0] = stage.joint(joints[k]) - stage.feet();
            if (i > 2) {
                found.fastest = std::max(found.fastest, glm::distance(last[0], last[1]) / kFrame);
                found.jerk = std::max(found.jerk, glm::length(last[0] - 2.0f * last[1] + last[2]));
            }
        }
    }
    return found;
}

}  // namespace

TEST_CASE(
    "matched hero: goes where it is told as fast as it is told, by motion matching, and stops"
    * technique("char.motion-select")) {
    for (const float speed : {1.4f, 4.2f}) {
        CAPTURE(speed);
        MatchedStage stage;
        CHECK_FALSE(stage.is_away());
        stage.go({speed, 0, 0});
        stage.step(300);
        const Vec3 begin = stage.feet();
        stage.step(60);
        CHECK(!stage.is_away());
        CHECK(std::abs(stage.feet().x - begin.x - speed) < 0.1f * speed);
        CHECK(std::abs(stage.feet().z - begin.z) < 0.1f * speed);
        CHECK(double(stage.feet().y) == near(0).epsilon(1e-3));
        stage.go(Vec3(0));
        stage.step(150);
        const Vec3 end = stage.feet();
        stage.step(60);
        CHECK(glm::distance(stage.feet(), end) < 0.02f);
        CHECK(stage.match().transitions > 2);
    }
}

namespace {

struct RunUp {
    int steps = 0;        ///< in the first 1.2 s
    float longest = 0;    ///< distance of the ankles along the way [leg lengths]
    float lowest = 1e6f;  ///< of the hips, of their height at rest
    std::vector<float> lengths = {};
};

/// From one speed to another.
template <typename Stage>
RunUp watch_run_up(float from, float to) {
    Stage stage;
    stage.step(60);
    const float leg = leg_length(stage.body());
    const float rest = stage.hips_height();
    stage.go({0, 0, from});
    stage.step(from > 0 ? 180 : 1);
    stage.go({0, 0, to});
    RunUp found;
    float before = 0;
    bool grew = false;
    for (int i = 0; i < 150; ++i) {
        stage.step();
        const WalkBody& body = stage.body();
        const float apart =
            std::abs(stage.joint(body.legs[0].foot).z - stage.joint(body.legs[1].foot).z) / leg;
        const bool grows = apart > before;
        if (grew && !grows && before > 0.2f) {  // a step is as long as ankles are apart at most
            found.lengths.push_back(before);
            found.steps += i < 72 ? 1 : 0;
        }
        grew = grows;
        before = apart;
        found.longest = std::max(found.longest, apart);
        found.lowest = std::min(found.lowest, stage.hips_height() / rest);
    }
    return found;
}

}  // namespace

TEST_CASE("run: it begins with short quick steps that get longer, and with the hips up") {
    // Motion matching gains speed as slowly as the takes.
    for (const bool matched : {false, true}) {
        CAPTURE(matched);
        const RunUp found =
            matched ? watch_run_up<MatchedStage>(0, 4.2f) : watch_run_up<PoseStage>(0, 4.2f);
        CHECK(found.steps >= (matched ? 2 : 3));
        CHECK(found.longest < 1.2f);
        CHECK(found.lowest > (matched ? 0.82f : 0.84f));
        REQUIRE(found.lengths.size() >= 4);
        CHECK(found.lengths[0] < 0.8f);
        CHECK(found.lengths[0] < 0.85f * found.longest);
        for (std::size_t i = 1; i < found.lengths.size(); ++i) {
            CHECK(found.lengths[i] > 0.7f * found.lengths[i - 1]);
        }
    }
}

TEST_CASE("run: ankles are never far apart when it begins, from a stand and from a walk") {
    for (const float from : {0.0f, 0.7f, 1.4f, 2.0f}) {
        for (const float to : {2.6f, 3.4f, 4.2f, 5.0f}) {
            CAPTURE(from);
            CAPTURE(to);
            for (const RunUp& found :
                 {watch_run_up<PoseStage>(from, to), watch_run_up<MatchedStage>(from, to)}) {
                CHECK(found.longest < 1.2f);
                CHECK(found.lowest > 0.8f);
            }
        }
    }
}

TEST_CASE(
    "matched hero: planted feet do not slide as it starts, turns, runs and stops"
    * technique("char.blend")) {
    MatchedStage stage;
    std::array<std::array<Vec3, 2>, 2> before{};
    std::array<float, 2> way{};
    std::array<bool, 2> was{};
    float slide = 0;
    int planted = 0;
    const std::array<Vec3, 5> tour = {
        Vec3(0, 0, 1.4f), Vec3(1.4f, 0, 0), Vec3(4.2f, 0, 0), Vec3(0, 0, -1.4f), Vec3(0)};
    for (const Vec3& wanted : tour) {
        stage.go(wanted);
        for (int i = 0; i < 120; ++i) {
            stage.step();
            for (std::uint32_t side = 0; side < 2; ++side) {
                const std::array<Vec3, 2> now = stage.sole(side);
                const auto moved = [&](std::size_t k) {
                    const Vec3 off = now[k] - before[side][k];
                    return std::hypot(off.x, off.z);
                };
                const bool is_planted = stage.is_planted(side);
                way[side] =
                    is_planted && was[side] ? way[side] + std::min(moved(0), moved(1)) : 0.0f;
                was[side] = is_planted;
                before[side] = now;
                planted += is_planted ? 1 : 0;
                slide = std::max(slide, way[side]);
            }
        }
    }
    CHECK(planted > 400);
    CHECK(slide < 0.002f);
}

TEST_CASE(
    "matched hero: jumps from a walk and a run, lands in it, and joints are as smooth as always"
    * technique("char.blend")) {
    for (const float speed : {0.0f, 1.4f, 4.2f}) {
        CAPTURE(speed);
        PoseStage plain;
        plain.go({0, 0, speed});
        plain.step(200);
        const Smoothness usual = watch_jump(plain, [](bool) {});
        MatchedStage stage;
        stage.go({0, 0, speed});
        stage.step(200);
        bool was_away = false;
        bool flew = false;
        const Smoothness found = watch_jump(stage, [&](bool flies) {
            was_away = was_away || stage.is_away();
            flew = flew || flies;
        });
        CHECK(was_away);
        CHECK(flew);
        CHECK_FALSE(stage.is_away());
        CHECK(double(stage.state().velocity.z) == near(double(speed)).epsilon(0.15));
        CHECK(found.fastest < 14);
        CHECK(found.jerk < usual.jerk + 0.02f);
    }
}

TEST_CASE("matched hero: stops at a wall, and goes on along it") {
    MatchedStage stage({make_box_mesh({-6, 0, 2}, {6, 3, 2.5f})});
    stage.go({0, 0, 1.4f});
    stage.step(300);
    CHECK(stage.feet().z < 2 - 0.27f);
    CHECK(stage.feet().z > 1.4f);
    CHECK(glm::length(stage.match().velocity) < 0.1f);
    const std::uint32_t transitions = stage.match().transitions;
    stage.step(120);
    CHECK(stage.match().transitions < transitions + 6);  // and does not walk on the spot
    stage.go({1, 0, 1});
    const float begin = stage.feet().x;
    stage.step(180);
    CHECK(stage.feet().x > begin + 1);
    CHECK(stage.feet().z < 2 - 0.27f);
}

TEST_CASE("matched hero: wades and pushes by the poses of its motor, and walks on by clips") {
    MatchedStage stage;
    stage.world.create(Transform{.position = {0, 0.9f, 5}}, Water{.size = {6, 4}, .depth = 0.9f});
    bool waded = false;
    stage.go({0, 0, 1.4f});
    for (int i = 0; i < 900 && stage.feet().z < 9; ++i) {
        stage.step();
        waded = waded || (stage.is_away() && stage.motion().wade.value > 0.3f);
    }
    CHECK(waded);
    CHECK(stage.feet().z >= 9);
    CHECK_FALSE(stage.is_away());

    MatchedStage pusher;
    const Entity crate = pusher.world.create(
        Transform{.position = {0, 0.5f, 2.2f}},
        LooseBody{.radius = 0.5f, .mass = 40, .bounce = 0, .rolls = false});
    pusher.go({0, 0, 0.9f});
    bool pushed = false;
    for (int i = 0; i < 240; ++i) {
        pusher.step();
        pushed = pushed || (pusher.is_away() && pusher.motion().push.value > 0.8f);
    }
    CHECK(pushed);
    CHECK(pusher.world.get<const Transform>(crate).position.z > 2.6f);
    pusher.go(Vec3(0));
    pusher.step(90);
    CHECK_FALSE(pusher.is_away());
}

TEST_CASE("matched hero: a snapshot in mid-jump and in a handover continues with the same bits") {
    for (const int frames : {3, 12, 60}) {
        MatchedStage stage;
        stage.go({0, 0, 3});
        stage.step(90);
        stage.jump();
        stage.step(frames);
        const Result<std::vector<std::byte>> saved = save_snapshot(stage.world);
        REQUIRE(saved.ok());
        MatchedStage again;
        REQUIRE(restore_snapshot(again.world, saved.value()).ok());
        for (int i = 0; i < 90; ++i) {
            stage.step();
            again.step();
            REQUIRE(state_hash(again.world) == state_hash(stage.world));
        }
    }
}

}  // namespace limn::motor_pose_test
