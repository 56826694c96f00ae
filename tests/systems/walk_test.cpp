#include "ecs/base/foot_flight.h"
#include "tests/near.h"
#include "tests/systems/walk_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace limn::walk_test {

using namespace limn::test;

namespace {

constexpr float kFrame = 1.0f / 60;

/// Different ways to go, as functions of time.
struct Course {
    const char* name;
    std::function<MoveIntent(float)> intent;
};

std::vector<Course> courses() {
    const auto toward = [](float heading, float speed) {
        return MoveIntent{.velocity = speed * heading_direction(heading)};
    };
    return {
        {"straight", [=](float) { return toward(0, 1.3f); }},
        {"stop and go",
         [=](float t) { return toward(0.3f, std::fmod(t, 3.0f) < 1.7f ? 1.2f : 0.0f); }},
        {"circle", [=](float t) { return toward(0.8f * t, 1.0f); }},
        {"turns back", [=](float t) { return toward(t < 3 ? 0.0f : 3.0f, 1.3f); }},
        {"turns on the spot",
         [=](float t) {
             return MoveIntent{.facing = heading_direction(t < 1 ? 0.0f : t < 4 ? 2.5f : -0.5f)};
         }},
        {"sideways and backward",
         [=](float t) {
             MoveIntent intent = toward(t < 3 ? 1.6f : 3.1f, 0.7f);
             intent.facing = {0, 0, 1};
             return intent;
         }},
    };
}

std::vector<Walk> styles() {
    Walk limping;
    limping.left = {.hip = 0.3f, .knee = 0.2f, .ankle = 0.3f};
    Walk tired;
    tired.tiredness = 1;
    Walk strides;
    strides.stride = 1.9f;
    strides.step_height = 0.12f;
    strides.speed = 1.5f;
    Walk old;
    old.stoop = 0.5f;
    old.knee_bend = 0.06f;
    old.stride = 0.8f;
    old.speed = 0.7f;
    old.width = 1.3f;
    return {{}, limping, tired, strides, old};
}

/// Runs a course and calls `check` after each frame.
void follow(
    WalkTrial& trial, const Course& course, float seconds,
    const std::function<void(const WalkTrial&)>& check) {
    for (float t = 0; t < seconds; t += kFrame) {
        trial.intent = course.intent(t);
        trial.step(kFrame);
        check(trial);
    }
}

/// The step in which a foot touches the ground for the `count`-th time.
void run_to_landing(WalkTrial& trial, std::size_t side, int count = 1, float dt = kFrame) {
    for (int i = 0; i < count; ++i) {
        while (!trial.is_flying(side)) {
            trial.step(dt);
        }
        while (trial.is_flying(side)) {
            trial.step(dt);
        }
    }
}

}  // namespace

TEST_CASE(
    "walk: planted toes do not move, heels neither while feet roll off them, whatever the course "
    "and the style"
    * technique("char.walk-cycle")) {
    for (const Walk& style : styles()) {
        for (const Course& course : courses()) {
            CAPTURE(course.name);
            WalkTrial trial(style);
            std::array<Vec3, 2> toes{};
            std::array<Vec3, 2> heels{};
            std::array<int, 2> planted{};
            std::array<int, 2> rolling{};
            float slide = 0;
            follow(trial, course, 7, [&](const WalkTrial& now) {
                for (std::size_t i = 0; i < 2; ++i) {
                    planted[i] = now.is_planted(i) ? planted[i] + 1 : 0;
                    rolling[i] = !now.is_planted(i) && !now.is_flying(i) ? rolling[i] + 1 : 0;
                    toes[i] = planted[i] == 1 ? now.toe(i) : toes[i];
                    heels[i] = rolling[i] == 1 ? now.heel(i) : heels[i];
                    const bool is_on_heel = rolling[i] > 0 && now.state.feet[i].pitch > 0;
                    slide = std::max(
                        {slide, planted[i] > 0 ? glm::distance(toes[i], now.toe(i)) : 0.0f,
                         is_on_heel ? glm::distance(heels[i], now.heel(i)) : 0.0f});
                }
            });
            CHECK(slide < 1e-4f * trial.leg());
        }
    }
}

TEST_CASE(
    "walk: feet follow the flight curve, and never go below the ground"
    * technique("char.foot-flight, char.walk-cycle")) {
    for (const Walk& style : styles()) {
        for (const Course& course : courses()) {
            CAPTURE(course.name);
            WalkTrial trial(style);
            float lowest = 0;
            float error = 0;
            follow(trial, course, 6, [&](const WalkTrial& now) {
                for (std::size_t i = 0; i < 2; ++i) {
                    const float s = now.state.step / kFlightShare;
                    const float height = now.is_flying(i) ? 0.5f * now.state.feet[i].height
                                                                * flight_height(s, now.walk.plateau)
                                                          : 0.0f;
                    lowest = std::min(lowest, now.clearance(i));
                    error = std::max(error, std::abs(now.clearance(i) - height));
                }
            });
            CHECK(lowest > -1e-4f);
            CHECK(error < 1e-4f);
        }
    }
}

TEST_CASE("walk: knees bend forward, and legs are never straight" * technique("char.walk-cycle")) {
    for (const Walk& style : styles()) {
        for (const Course& course : courses()) {
            CAPTURE(course.name);
            WalkTrial trial(style);
            float least = 1;
            float most = 0;
            follow(trial, course, 6, [&](const WalkTrial& now) {
                for (std::size_t i = 0; i < 2; ++i) {
                    least = std::min(least, now.knee(i));
                    most = std::max(most, now.knee(i));
                }
            });
            CHECK(least > 0.02f);
            CHECK(most < 2.2f);
        }
    }
}

TEST_CASE(
    "walk: a cycle covers the stride, hips move at stride per cycle"
    * technique("char.walk-cycle, char.walk-control")) {
    const auto cycle_of = [](float stride) {
        Walk style;
        style.stride = stride;
        WalkTrial trial(style);
        trial.run(4);
        run_to_landing(trial, 0, 1, 1e-3f);
        const Vec3 foot = trial.state.feet[0].to;
        const float begin = trial.transform.position.z;
        float seconds = 0;
        while (!trial.is_flying(0)) {
            trial.step(1e-3f);
            seconds += 1e-3f;
        }
        while (trial.is_flying(0)) {
            trial.step(1e-3f);
            seconds += 1e-3f;
        }
        CHECK((trial.transform.position.z - begin) / seconds == near(1.3).epsilon(1e-3));
        return std::array<float, 2>{glm::distance(trial.state.feet[0].to, foot), seconds};
    };
    const auto shorter = cycle_of(0.7f);
    const auto longer = cycle_of(1.4f);
    CHECK(shorter[0] == near(0.7).epsilon(2e-3));
    CHECK(longer[0] == near(1.4).epsilon(2e-3));
    CHECK(longer[1] / shorter[1] == near(2).epsilon(5e-3));
}

TEST_CASE(
    "walk: left and right have the same angles half a cycle apart, and each cycle is like the last"
    * technique("char.walk-cycle")) {
    WalkTrial trial;
    trial.run(5);
    const float cycle = find_stride(trial.walk, trial.leg(), 1.3f).duration;
    constexpr int kSteps = 48;
    const float dt = cycle / (2 * kSteps);
    std::vector<std::array<float, 2>> knees;
    std::vector<std::array<float, 2>> pitches;
    for (int i = 0; i < 4 * kSteps; ++i) {
        trial.step(dt);
        knees.push_back({trial.knee(0), trial.knee(1)});
        pitches.push_back({trial.state.feet[0].pitch, trial.state.feet[1].pitch});
    }
    float shift = 0;
    float repeat = 0;
    float range = 0;
    for (std::size_t i = 0; i < 2 * kSteps; ++i) {
        shift = std::max(shift, std::abs(knees[i][0] - knees[i + kSteps][1]));
        shift = std::max(shift, std::abs(pitches[i][0] - pitches[i + kSteps][1]));
        repeat = std::max(repeat, std::abs(knees[i][0] - knees[i + 2 * kSteps][0]));
        range = std::max(range, knees[i][0]);
    }
    CHECK(shift < 5e-3f);
    CHECK(repeat < 5e-3f);
    CHECK(range > 0.7f);  // they do bend
}

TEST_CASE(
    "walk: joints change their speeds without jumps, also where it starts, turns and stops"
    * technique("char.walk-cycle")) {
    // The change of speed from one step to the next is proportional to the step, where speeds are
    // continuous; where they jump it is not.
    const auto largest_change = [](const Course& course, const Walk& style, float dt) {
        WalkTrial trial(style);
        std::vector<Quat> before = trial.pose.rotations;
        std::vector<Vec3> speeds(before.size(), Vec3(0));
        float largest = 0;
        for (float t = 0; t < 5; t += dt) {
            trial.intent = course.intent(t);
            trial.step(dt);
            for (std::size_t j = 0; j < before.size(); ++j) {
                const Quat turn = glm::conjugate(before[j])
                                  * to_same_hemisphere(before[j], trial.pose.rotations[j]);
                const Vec3 speed = 2.0f / dt * log_rotation(normalize_or_identity(turn));
                largest = std::max(largest, t > 2 * dt ? glm::distance(speed, speeds[j]) : 0.0f);
                speeds[j] = speed;
            }
            before = trial.pose.rotations;
        }
        return largest;
    };
    for (const Walk& style : styles()) {
        for (const Course& course : courses()) {
            CAPTURE(course.name);
            const float coarse = largest_change(course, style, 1.0f / 240);
            const float fine = largest_change(course, style, 1.0f / 960);
            CAPTURE(coarse);
            CAPTURE(fine);
            CHECK(fine < std::max(0.5f * coarse, 0.45f));
        }
    }
}

TEST_CASE(
    "walk: height, arms and hips do what their parameters say, and nothing else"
    * technique("char.walk-control")) {
    const auto peaks = [](const Walk& style) {
        struct Peaks {
            float height = 0;
            float left_arm = 0;
            float right_arm = 0;
            float together = 0;  ///< of left arm and left leg
            float yaw = 0;
            float distance = 0;
        };
        WalkTrial trial(style);
        trial.run(4);
        Peaks peak;
        const float begin = trial.transform.position.z;
        for (int i = 0; i < 300; ++i) {
            trial.step(kFrame / 3);
            peak.height = std::max({peak.height, trial.clearance(0), trial.clearance(1)});
            const auto swing = [&](std::size_t side) {
                const WalkArm& arm = trial.body.arms[side];
                const Vec3 way = trial.place(arm.fore).position - trial.place(arm.upper).position;
                return std::atan2(way.z, -way.y);
            };
            peak.left_arm = std::max(peak.left_arm, std::abs(swing(0)));
            peak.right_arm = std::max(peak.right_arm, std::abs(swing(1)));
            const Vec3 leg = trial.place(trial.body.legs[0].foot).position
                             - trial.place(trial.body.legs[0].thigh).position;
            peak.together += swing(0) * leg.z;
            const Vec3 ahead = trial.place(trial.body.hips).rotation * Vec3(0, 0, 1);
            peak.yaw = std::max(peak.yaw, std::abs(std::atan2(ahead.x, ahead.z)));
        }
        peak.distance = trial.transform.position.z - begin;
        return peak;
    };
    Walk style;
    style.plateau = 0;
    style.step_height = 0.04f;
    style.arm_swing = 0.3f;
    style.hip_yaw = 0;
    const auto plain = peaks(style);
    CHECK(plain.height == near(0.04).epsilon(5e-3));
    CHECK(plain.left_arm == near(0.3).epsilon(0.03));
    CHECK(plain.right_arm == near(0.3).epsilon(0.03));
    CHECK(plain.together < 0);  // against the leg
    CHECK(plain.yaw < 1e-3f);
    style.step_height = 0.08f;
    style.arm_swing = 0.6f;
    style.hip_yaw = 0.2f;
    const auto more = peaks(style);
    CHECK(more.height == near(0.08).epsilon(5e-3));
    CHECK(more.left_arm == near(0.6).epsilon(0.03));
    CHECK(more.yaw == near(0.2).epsilon(0.03));
    CHECK(more.distance == near(plain.distance).epsilon(1e-5));
}

TEST_CASE(
    "walk: it stands with its feet side by side after each stop" * technique("char.walk-cycle")) {
    for (const float seconds : {1.0f, 1.4f, 1.9f, 2.3f, 3.1f}) {
        WalkTrial trial;
        trial.run(seconds);
        trial.intent = {};
        trial.run(3);
        CHECK(trial.state.flying == WalkState::kNoFoot);
        CHECK(glm::length(trial.state.velocity) < 1e-3f);
        for (std::uint32_t i = 0; i < 2; ++i) {
            const WalkSize size = {trial.leg(), {trial.body.legs[0].side, trial.body.legs[1].side}};
            const Footprint home = home_print(
                effective_walk(trial.walk), size, i, {trial.state.root, trial.state.heading});
            CHECK(glm::distance(home.place, trial.state.feet[i].place) < 0.035f * trial.leg());
            CHECK(std::abs(trial.state.feet[i].pitch) < 0.02f);
            CHECK(trial.knee(i) < 0.5f);
        }
    }
}

TEST_CASE("walk: it turns on the spot by steps, and then faces where it should") {
    WalkTrial trial;
    trial.intent = {.velocity = {}, .facing = {1, 0, -0.2f}};
    int steps = 0;
    std::uint32_t flying = WalkState::kNoFoot;
    for (int i = 0; i < 300; ++i) {
        trial.step(kFrame);
        steps += trial.state.flying != flying && trial.state.flying != WalkState::kNoFoot ? 1 : 0;
        flying = trial.state.flying;
    }
    CHECK(steps >= 3);
    CHECK(steps <= 9);
    CHECK(trial.state.flying == WalkState::kNoFoot);
    CHECK(glm::length(trial.transform.position) < 1e-4f);
    const Vec3 ahead = trial.transform.rotation * Vec3(0, 0, 1);
    CHECK(glm::dot(ahead, normalize_or(Vec3(1, 0, -0.2f), {})) > 0.999f);
    for (const WalkFoot& foot : trial.state.feet) {
        CHECK(std::abs(wrap_angle(foot.heading - trial.state.heading)) < 0.13f);
    }
}

TEST_CASE(
    "walk: nobody walks faster, nor steps longer, than the legs allow"
    * technique("char.walk-cycle")) {
    CHECK(max_walk_speed(0.9f) == near(2.2).epsilon(0.01));
    for (const float scale : {0.4f, 1.0f, 3.0f}) {
        Walk style;
        style.stride = 10;
        WalkTrial trial(style, make_stick_person(scale));
        trial.intent.velocity = {0, 0, 50};
        trial.run(6);
        CHECK(trial.state.velocity.z == near(max_walk_speed(trial.leg())).epsilon(1e-3));
        float longest = 0;
        for (int i = 0; i < 120; ++i) {
            trial.step(kFrame);
            longest =
                std::max(longest, glm::distance(trial.state.feet[0].to, trial.state.feet[0].from));
            CHECK(trial.knee(0) > 0.02f);
        }
        CHECK(longest < 2 * trial.leg());
        CHECK(longest > 1.5f * trial.leg());
    }
}

TEST_CASE(
    "walk: a weak leg takes shorter steps and less time, a stiff knee bends less"
    * technique("char.walk-control")) {
    struct StepMeasures {
        std::array<float, 2> bend = {};
        std::array<float, 2> ahead = {};
        std::array<int, 2> alone = {};  ///< frames on one foot
    };
    const auto gait_of = [](const Walk& style) {
        WalkTrial trial(style);
        trial.run(4);
        StepMeasures gait;
        for (int i = 0; i < 600; ++i) {
            trial.step(kFrame);
            for (std::size_t side = 0; side < 2; ++side) {
                gait.bend[side] = std::max(gait.bend[side], trial.knee(side));
                gait.ahead[side] = std::max(
                    gait.ahead[side], trial.state.feet[side].place.z - trial.transform.position.z);
                gait.alone[side] += trial.is_flying(1 - side) ? 1 : 0;
            }
        }
        return gait;
    };
    Walk style;
    style.left = {.hip = 0.3f, .knee = 0.1f, .ankle = 0.5f};
    const StepMeasures limping = gait_of(style);
    CHECK(limping.bend[0] < 0.85f * limping.bend[1]);
    CHECK(limping.ahead[0] < 0.75f * limping.ahead[1]);
    CHECK(limping.alone[0] < 0.8f * static_cast<float>(limping.alone[1]));
    const StepMeasures even = gait_of({});
    CHECK(even.ahead[0] == near(even.ahead[1]).epsilon(0.05));
    CHECK(std::abs(even.alone[0] - even.alone[1]) < 30);
}

TEST_CASE(
    "walk: feet follow a curve of their own where the style has one"
    * technique("char.foot-flight")) {
    Walk style;
    style.flight = {{0, 0}, {0.1f, 0.9f}, {0.5f, 1}, {0.8f, 0.3f}, {1, 0}};
    for (std::size_t i = 0; i < style.flight.size(); ++i) {
        const Vec2 point = flight_point(style, static_cast<float>(i) / 4);
        CHECK(point.x == near(style.flight[i].x).scale(1e-3));
        CHECK(point.y == near(style.flight[i].y).scale(1e-3));
    }
    float jump = 0;
    for (float s = 0.002f; s < 0.998f; s += 0.001f) {
        const Vec2 ahead = flight_point(style, s + 1e-3f) - flight_point(style, s);
        const Vec2 behind = flight_point(style, s) - flight_point(style, s - 1e-3f);
        jump = std::max(jump, glm::distance(ahead, behind) / 1e-3f);
    }
    CHECK(jump < 0.2f);  // slopes of up to 4
    WalkTrial trial(style);
    trial.run(4);
    float height = 0;
    for (int i = 0; i < 200; ++i) {
        trial.step(kFrame / 2);
        if (trial.is_flying(0)) {
            const Vec2 point = flight_point(style, trial.state.step / kFlightShare);
            CHECK(trial.clearance(0) == near(point.y * trial.state.feet[0].height).scale(1));
            height = std::max(height, point.y);
        }
    }
    CHECK(height > 0.98f);
}

TEST_CASE("walk: tiredness lowers feet, head and hips" * technique("char.walk-control")) {
    const auto mean_of = [](float tiredness) {
        Walk style;
        style.tiredness = tiredness;
        WalkTrial trial(style);
        trial.run(3);
        Vec3 mean(0);  // of head and hips, highest of a foot
        for (int i = 0; i < 240; ++i) {
            trial.step(kFrame);
            mean.x += trial.place(3).position.y / 240;
            mean.y += trial.place(0).position.y / 240;
            mean.z = std::max(mean.z, trial.clearance(0));
        }
        return mean;
    };
    const Vec3 fresh = mean_of(0);
    const Vec3 tired = mean_of(1);
    CHECK(tired.x < fresh.x - 0.01f);
    CHECK(tired.y < fresh.y - 0.005f);
    CHECK(tired.z < 0.7f * fresh.z);
}

TEST_CASE("walk: below a root that something else moves, feet do not slide either") {
    Walk style;
    style.moves_root = false;
    WalkTrial trial(style);
    std::array<Vec3, 2> toes{};
    std::array<bool, 2> was{};
    float slide = 0;
    int steps = 0;
    std::uint32_t flying = WalkState::kNoFoot;
    for (int i = 0; i < 600; ++i) {
        const float angle = 0.3f * static_cast<float>(i) * kFrame;  // 1.2 m/s on a circle of 4 m
        trial.transform.position = {4 - 4 * std::cos(angle), 0, 4 * std::sin(angle)};
        trial.transform.rotation = rotation_about({0, 1, 0}, angle);
        const Transform before = trial.transform;
        trial.step(kFrame);
        CHECK(trial.transform.position == before.position);
        steps += trial.state.flying != flying ? 1 : 0;
        flying = trial.state.flying;
        for (std::size_t side = 0; side < 2; ++side) {
            const bool is = trial.is_planted(side);
            toes[side] = is && !was[side] ? trial.toe(side) : toes[side];
            slide = std::max(slide, is ? glm::distance(toes[side], trial.toe(side)) : 0.0f);
            was[side] = is;
        }
    }
    CHECK(slide < 1e-4f);
    CHECK(steps >= 15);
    CHECK(steps <= 22);
}

TEST_CASE("walk: steps of 0 s change nothing, one of 1 s is 60 of a frame") {
    WalkTrial trial;
    trial.run(1.3f);
    WalkTrial still = trial;
    still.step(0);
    CHECK(still.transform.position == trial.transform.position);
    CHECK(still.state.step == trial.state.step);
    CHECK(still.pose.rotations == trial.pose.rotations);
    WalkTrial slow = trial;
    slow.step(1);
    trial.run(1);
    CHECK(glm::distance(slow.transform.position, trial.transform.position) < 1e-3f);
    CHECK(std::abs(slow.state.step - trial.state.step) < 1e-2f);
}

TEST_CASE("walk: other axes and scales of a skeleton give the same walk") {
    WalkTrial plain;
    WalkTrial turned({}, make_stick_person(1, true));
    WalkTrial small({}, make_stick_person(0.5f));
    small.transform.scale = Vec3(2);
    small.state = {};
    small.step(0);
    for (int i = 0; i < 200; ++i) {
        for (WalkTrial* trial : {&plain, &turned, &small}) {
            trial->intent.velocity = {0.4f, 0, 1.2f};
            trial->step(kFrame);
        }
        constexpr std::array<std::uint16_t, 8> kJoints = {0, 3, 5, 6, 7, 10, 14, 16};
        for (const std::uint16_t joint : kJoints) {
            const Vec3 place = plain.world(plain.place(joint).position);
            CHECK(glm::distance(place, turned.world(turned.place(joint).position)) < 1e-3f);
            CHECK(glm::distance(place, small.world(small.place(joint).position)) < 1e-3f);
        }
    }
}

TEST_CASE("walk: NaN, infinite intents, no legs and bones of length 0 leave a finite pose") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const auto is_sane = [](const WalkTrial& trial) {
        bool sane = is_finite(trial.transform.position);
        for (std::size_t j = 0; j < trial.pose.size(); ++j) {
            const Quat& q = trial.pose.rotations[j];
            sane = sane && std::isfinite(q.w + q.x + q.y + q.z)
                   && is_finite(trial.pose.translations[j]);
        }
        return sane;
    };
    for (const Vec3& velocity : {Vec3(kNan), Vec3(INFINITY, 0, 0), Vec3(1e30f)}) {
        WalkTrial trial;
        trial.run(0.5f);
        trial.intent.velocity = velocity;
        trial.intent.facing = velocity;
        trial.run(1);
        CHECK(is_sane(trial));
    }
    Walk broken;
    broken.speed = kNan;
    broken.stride = -1;
    broken.step_height = kNan;
    broken.arm_swing = kNan;
    broken.sway = INFINITY;
    broken.response = 0;
    broken.left.knee = kNan;
    WalkTrial nan(broken);
    nan.intent.velocity = {0, 0, 1};
    nan.run(2);
    CHECK(is_sane(nan));
    SkeletonData folded = make_stick_person();
    for (Vec3& translation : folded.rest.translations) {
        translation = Vec3(0);
    }
    WalkTrial none({}, folded);
    none.run(1);
    CHECK(is_sane(none));
    CHECK_FALSE(none.body.can_walk);
    SkeletonData legless = make_stick_person();
    for (std::string& joint : legless.joints) {
        joint = "bone";
    }
    WalkTrial bones({}, legless);
    bones.run(1);
    CHECK_FALSE(bones.body.can_walk);
    CHECK(bones.pose.rotations == legless.rest.rotations);
    WalkTrial lost;
    lost.transform.position.x = kNan;
    lost.run(0.2f);
    lost.transform.position = {5, 0, 5};
    lost.run(1);
    CHECK(is_sane(lost));
    CHECK(glm::distance(lost.state.feet[0].place, lost.transform.position) < 2);
}

}  // namespace limn::walk_test
