// Characters by motion matching: they go where they want to, on feet that do not slide, without
// jumps where clips change.

#include "ecs/base/jobs.h"
#include "ecs/snapshot.h"
#include "systems/animation/matching/match_feet.h"
#include "systems/animation/matching/match_step.h"
#include "tests/systems/match_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace limn::motion_match_test {

using namespace limn::test;

namespace {

constexpr float kFrame = 1.0f / 60;
const Vec3 kFlat(1, 0, 1);
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// What a tour of starts, runs, turns and stops wants at a time.
Vec3 tour_velocity(float time) {
    const std::array<std::pair<float, Vec3>, 9> parts = {
        {{1.0f, {0, 0, 0}},
         {3.5f, {0, 0, 1.3f}},
         {5.5f, {1.3f, 0, 0}},
         {7.5f, {3.8f, 0, 0}},
         {9.5f, {0, 0, -3.8f}},
         {11.0f, {0, 0, 0}},
         {13.5f, {0, 0, 2.6f}},
         {15.5f, {-1.3f, 0, -0.6f}},
         {17.0f, {0, 0, 0}}}};
    for (const auto& [until, velocity] : parts) {
        if (time < until) {
            return velocity;
        }
    }
    return Vec3(0);
}

/// Runs the tour and calls `check` after each step.
template <typename Check>
void run_tour(MatchStage& stage, Check&& check) {
    for (int i = 0; i < 17 * 60; ++i) {
        stage.go(tour_velocity(static_cast<float>(i) * kFrame));
        stage.step();
        check(i);
    }
}

float speed_of(const MotionMatchState& state) {
    return glm::length(state.velocity);
}

}  // namespace

TEST_CASE("motion match: who wants nothing stands still" * technique("char.motion-select")) {
    MatchStage stage;
    stage.step(60);
    const Vec3 place = stage.at().position;
    const Vec3 hand = stage.joint(10);
    stage.step(240);
    CHECK(glm::distance(stage.at().position, place) < 0.01f);
    CHECK(glm::distance(stage.joint(10), hand) < 0.03f);
    CHECK(speed_of(stage.state()) < 0.01f);
}

TEST_CASE(
    "motion match: it reaches the wanted speed and direction, and stops"
    * technique("char.motion-select")) {
    for (const float speed : {1.3f, 2.7f, 4.0f}) {
        for (const float angle : {0.0f, 1.6f, -2.4f}) {
            CAPTURE(speed);
            CAPTURE(angle);
            MatchStage stage;
            stage.step(10);
            const Vec3 way(std::sin(angle), 0, std::cos(angle));
            stage.go(speed * way);
            stage.step(360);
            const Vec3 begin = stage.at().position;
            stage.step(60);
            const float mean = glm::dot(stage.at().position - begin, way);
            CHECK(std::abs(mean - speed) < 0.1f * speed);
            CHECK(glm::dot(stage.at().rotation * Vec3(0, 0, 1), way) > 0.98f);
            stage.go(Vec3(0));
            stage.step(180);
            CHECK(speed_of(stage.state()) < 0.05f);
        }
    }
}

TEST_CASE(
    "motion match: between the speeds of the takes, clips play faster or slower"
    * technique("char.motion-select")) {
    std::array<float, 2> sums{};
    for (const float speed : {2.4f, 3.3f, 3.6f}) {
        CAPTURE(speed);
        for (const float pace : {0.2f, 0.0f}) {
            MotionMatch match;
            match.pace = pace;
            MatchStage stage(match);
            stage.go({0, 0, speed});
            stage.step(360);
            const float begin = stage.at().position.z;
            stage.step(120);
            const float off = std::abs(0.5f * (stage.at().position.z - begin) - speed) / speed;
            CHECK((off < 0.05f || pace == 0));
            CHECK(std::abs(stage.state().pace - 1) <= pace);
            sums[pace > 0 ? 0 : 1] += off;
        }
    }
    CHECK(sums[0] < 0.7f * sums[1]);
}

TEST_CASE(
    "motion match: toward directions between those of the clips it is steered"
    * technique("char.motion-select")) {
    std::array<float, 2> off{};
    for (const float angle : {0.15f, -0.3f, 0.45f, -0.6f}) {
        CAPTURE(angle);
        for (const float steer : {MotionMatch{}.steer, 0.0f}) {
            MotionMatch match;
            match.steer = steer;
            MatchStage stage(match);
            stage.go({0, 0, 1.3f});
            stage.step(180);
            const Vec3 way(std::sin(angle), 0, std::cos(angle));
            stage.go(1.3f * way);
            float sum = 0;
            for (int i = 0; i < 180; ++i) {
                stage.step();
                CHECK(std::abs(stage.state().steering) <= steer);
                sum += glm::distance(stage.at().rotation * Vec3(0, 0, 1), way) / 180;
            }
            off[steer > 0 ? 0 : 1] += sum;
        }
    }
    CHECK(off[0] < 0.7f * off[1]);
}

TEST_CASE("motion match: no clip is left before it has played for a while, but by those who stop") {
    MatchStage stage;
    std::uint32_t before = 0;
    int last = -100;
    int shortest = 100;
    run_tour(stage, [&](int frame) {
        const bool goes = tour_velocity(static_cast<float>(frame) * kFrame) != Vec3(0);
        if (stage.state().transitions != before) {
            shortest = goes ? std::min(shortest, frame - last) : shortest;
            before = stage.state().transitions;
            last = frame;
        }
    });
    CHECK(before > 20);
    CHECK(shortest >= 12);
}

TEST_CASE(
    "motion match: planted feet do not slide, whatever clips change" * technique("char.blend")) {
    MatchStage stage;
    stage.step(2);
    const WalkBody body = find_walk_body(make_stick_person());
    std::array<std::array<Vec3, 2>, 2> before{};  // heel and ball of each foot
    std::array<bool, 2> was{};
    std::array<float, 2> way{};
    float slide = 0;
    int planted = 0;
    run_tour(stage, [&](int) {
        for (std::size_t side = 0; side < 2; ++side) {
            const bool is_planted = stage.state().feet[side].planted == 1;
            const std::array<Vec3, 2> now = stage.foot_points(body.legs[side]);
            // A foot rolls over its heel, then over its ball; one of them stays.
            way[side] += std::min(
                glm::distance(before[side][0] * kFlat, now[0] * kFlat),
                glm::distance(before[side][1] * kFlat, now[1] * kFlat));
            way[side] = is_planted && was[side] ? way[side] : 0.0f;
            was[side] = is_planted;
            before[side] = now;
            planted += is_planted ? 1 : 0;
            slide = std::max(slide, way[side]);
        }
    });
    CHECK(planted > 600);
    CHECK(stage.state().transitions > 10);
    CHECK(slide < 0.002f);
}

TEST_CASE(
    "motion match: a foot comes down before it stands, also where clips change"
    * technique("char.blend")) {
    MatchStage stage;
    stage.step(2);
    const WalkBody body = find_walk_body(make_stick_person());
    std::array<bool, 2> stood{};
    int stands = 0;
    float highest = 0;
    float farthest = 0;
    for (int i = 0; i < 3000; ++i) {
        // Changes its mind in the middle of steps.
        const auto k = static_cast<float>(i / 23);
        stage.go({3 * std::sin(2.4f * k), 0, 3 * std::cos(1.7f * k)});
        stage.step();
        for (std::size_t side = 0; side < 2; ++side) {
            const MatchFoot& foot = stage.state().feet[side];
            const std::array<Vec3, 2> points = stage.foot_points(body.legs[side]);
            if (foot.planted == 1 && !stood[side]) {
                const float height = std::min(points[0].y, points[1].y - body.legs[side].ball.y);
                highest = std::max(highest, height);
                farthest = std::max(farthest, glm::distance(foot.place * kFlat, foot.aim * kFlat));
                ++stands;
            }
            stood[side] = foot.planted == 1;
        }
    }
    CHECK(stands > 60);
    CHECK(highest < 0.06f);  // heels come first, with the ball up
    CHECK(farthest < 0.3f * body.legs[0].length);
}

TEST_CASE("motion match: the root lags for a third of a blend, then it moves as the clip does") {
    MatchStage stage;
    stage.step(2);
    const float lag = 0.3f * MotionMatch{}.blend;
    MotionMatchState last = stage.state();
    Transform from = stage.at();
    float off = 0;
    float off_lagging = 0;
    int exact = 0;
    run_tour(stage, [&](int) {
        const MotionMatchState& now = stage.state();
        if (now.transitions == last.transitions && now.time > last.time) {
            const MatchClip& clip = stage.database().clips[now.clip];
            const GroundMove move =
                compose(inverse(root_of(clip, last.time)), root_of(clip, now.time));
            const Vec3 way = from.rotation * Vec3(move.way.x, 0, move.way.y);
            const float error = glm::distance(stage.at().position - from.position, way) / kFrame;
            const bool lags = last.blending != 0 && last.clock < lag;
            (lags ? off_lagging : off) = std::max(lags ? off_lagging : off, error);
            exact += lags ? 0 : 1;
        }
        last = now;
        from = stage.at();
    });
    CHECK(exact > 500);
    CHECK(off < 1e-3f);
    CHECK(off_lagging > 0.2f);
}

TEST_CASE("motion match: transitions do not jump, cuts do" * technique("char.blend")) {
    std::array<float, 2> jumps{};
    std::array<std::uint32_t, 2> counts{};
    for (const bool cuts : {false, true}) {
        MotionMatch match;
        match.blend = cuts ? 0.0f : 0.35f;
        MatchStage stage(match);
        stage.step(4);
        std::vector<std::array<Vec3, 17>> way;
        float largest = 0;
        std::uint32_t last = 0;
        run_tour(stage, [&](int i) {
            std::array<Vec3, 17> places{};
            for (std::uint16_t j = 0; j < places.size(); ++j) {
                places[j] = stage.joint(j);
            }
            way.push_back(places);
            const bool switched = stage.state().transitions != last;
            last = stage.state().transitions;
            if (i < 3 || !switched) {
                return;
            }
            // Off where it would be if it had gone on.
            const auto& a = way[way.size() - 3];
            const auto& b = way[way.size() - 2];
            for (std::size_t j = 0; j < places.size(); ++j) {
                largest = std::max(largest, glm::distance(places[j], 2.0f * b[j] - a[j]));
            }
        });
        jumps[cuts ? 1 : 0] = largest;
        counts[cuts ? 1 : 0] = last;
    }
    CAPTURE(counts[0]);
    CHECK(jumps[0] < 0.08f);
    CHECK(jumps[1] > 0.2f);
}

TEST_CASE(
    "motion match: it stops as soon as people do, in whatever phase of a step"
    * technique("char.motion-select")) {
    // Walking, jogging and running [m/s]; time until it is slower than 0.1 m/s [s].
    const std::array<std::pair<float, float>, 3> limits = {
        {{1.3f, 1.15f}, {2.7f, 1.45f}, {4.0f, 1.8f}}};
    for (const std::pair<float, float>& each : limits) {
        const float speed = each.first;
        const float limit = each.second;
        for (int phase = 0; phase < 12; ++phase) {
            CAPTURE(speed);
            CAPTURE(phase);
            MatchStage stage;
            stage.step(10);
            stage.go({0, 0, speed});
            stage.step(300 + 4 * phase);
            stage.go(Vec3(0));
            int last = 0;
            for (int i = 1; i <= 240; ++i) {
                stage.step();
                last = speed_of(stage.state()) > 0.1f ? i : last;
            }
            CHECK(static_cast<float>(last) * kFrame < limit);
        }
    }
}

TEST_CASE("motion match: no joint jumps, nor does its velocity" * technique("char.blend")) {
    // So short that accelerations do not count: a leg that gets straight has the largest.
    constexpr float kShort = 1.0f / 1920;
    MatchStage stage;
    stage.step(4);
    std::array<std::array<Vec3, 17>, 3> way{};
    float largest = 0;
    for (int i = 0; i < 17 * 1920; ++i) {
        stage.go(tour_velocity(static_cast<float>(i) * kShort));
        stage.step(1, kShort);
        std::rotate(way.begin(), way.begin() + 2, way.end());
        for (std::uint16_t j = 0; j < way[0].size(); ++j) {
            way[0][j] = stage.joint(j);
            const Vec3 change = way[0][j] - 2.0f * way[1][j] + way[2][j];
            largest = std::max(largest, i < 3 ? 0.0f : glm::length(change));
        }
    }
    CHECK(stage.state().transitions > 10);
    CHECK(largest < 0.006f);
}

TEST_CASE("motion match: a foot that is off the clip's steps to it and does not drag") {
    MatchFoot foot;
    FootAim aim;
    aim.local.place = {0, 0.02f, 0};
    aim.sole = 0.02f;
    aim.hip = {0, 0.8f, 0};
    aim.leg = 0.9f;
    aim.heel = {0, -0.02f, -0.1f};
    aim.contact = true;
    place_foot(aim, {}, foot);
    foot.place = {0, 0.02f, -0.25f};
    aim.contact = false;
    capture_foot(aim, {}, {}, foot);
    float highest = 0;
    for (int i = 0; i < 21; ++i) {
        const float before = foot.place.z;
        step_foot(aim, {}, 0.35f, 0.3f, kFrame, foot);
        highest = std::max(highest, foot.place.y - aim.sole);
        // It is fast only where it is up.
        CHECK((foot.place.z - before) / kFrame < 0.5f + 70 * (foot.place.y - aim.sole));
    }
    CHECK(highest > 0.05f);
    CHECK(highest < 0.07f);
    CHECK(glm::distance(foot.place, aim.local.place) < 0.001f);
}

TEST_CASE("motion match: a foot that stands reaches its print, and none is below the ground") {
    MatchStage stage;
    stage.step(2);
    const SkeletonData skeleton = make_stick_person();
    const WalkBody body = find_walk_body(skeleton);
    float off = 0;
    float lowest = 1;
    run_tour(stage, [&](int) {
        for (std::size_t side = 0; side < 2; ++side) {
            const Vec3 toe = stage.joint(body.legs[side].toes);
            if (stage.state().feet[side].planted == 1) {
                off = std::max(off, glm::distance(toe, stage.state().feet[side].place));
            }
            lowest = std::min(lowest, toe.y);
        }
    });
    CHECK(off < 0.01f);
    CHECK(lowest > 0.005f);
}

TEST_CASE("motion match: steps of 0 s change nothing, one of 1 s is finite and goes as far") {
    MatchStage stage;
    stage.step(10);
    stage.go({0, 0, 1.3f});
    stage.step(120);
    const MotionMatchState before = stage.state();
    const Transform at = stage.at();
    const Vec3 foot = stage.joint(6);
    stage.step(3, 0);
    CHECK(stage.at().position == at.position);
    CHECK(stage.state().time == before.time);
    CHECK(stage.state().transitions == before.transitions);
    CHECK(stage.joint(6) == foot);
    stage.step(1, 1);
    CHECK(is_finite(stage.at().position));
    CHECK(std::abs(glm::distance(stage.at().position, at.position) - 1.3f) < 0.2f);
}

TEST_CASE("motion match: missing and short clips, no legs, NaN: no crash, and it stands") {
    ClipData brief;
    brief.name = "brief";
    brief.duration = 0.5f;
    brief.sheets.emplace_back().times = {0, 0.5f};
    MotionMatch match;
    match.clips = {{0}, {7}};
    MatchStage stage(match, {brief});
    stage.go({0, 0, kNan});
    stage.step(5);
    CHECK(stage.database().rows.count == 0);
    CHECK(stage.state().started == 0);
    CHECK(stage.at().position == Vec3(0));

    MatchStage wild;
    wild.step(5);
    wild.go({kNan, 0, 1}, {kNan, 0, 0});
    wild.step(20);
    CHECK(is_finite(wild.at().position));
    wild.world.get<Transform>(wild.person).position.x = kNan;
    wild.step(2);
    wild.world.get<Transform>(wild.person).position.x = 5;
    wild.go({0, 0, 1});
    wild.step(60);
    CHECK(is_finite(wild.at().position));
    CHECK(is_finite(wild.joint(9)));
}

TEST_CASE(
    "motion match: a snapshot in the middle of a transition continues with the same bits"
    * technique("char.blend")) {
    MatchStage stage;
    stage.step(10);
    stage.go({1.3f, 0, 1});
    stage.step(40);
    for (int i = 0; i < 200 && !(stage.state().blending != 0 && stage.state().clock > 0.1f); ++i) {
        stage.go({i % 50 < 25 ? 2.0f : -1.0f, 0, 1});
        stage.step();
    }
    REQUIRE(stage.state().blending != 0);
    const Result<std::vector<std::byte>> saved = save_snapshot(stage.world);
    REQUIRE(saved.ok());
    MatchStage restored;
    REQUIRE(restore_snapshot(restored.world, *saved).ok());
    for (int i = 0; i < 90; ++i) {
        stage.step();
        restored.step();
        CHECK(state_hash(restored.world) == state_hash(stage.world));
    }
}

TEST_CASE("motion match: the same bits on 1, 2, 3 and 7 threads") {
    const int before = thread_count();
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3, 7}) {
        set_thread_count(threads);
        MatchStage stage;
        for (int i = 1; i < 40; ++i) {
            const float x = static_cast<float>(i);
            const Entity walker = stage.add({}, {.position = {2 * x, 0, 0}});
            stage.world.get<MoveIntent>(walker).velocity = {std::sin(x), 0, 0.1f * x};
        }
        stage.step(60);
        hashes.push_back(state_hash(stage.world));
    }
    set_thread_count(before);
    CHECK(hashes == std::vector<std::uint64_t>(4, hashes[0]));
}

}  // namespace limn::motion_match_test
