// The database of motion matching: features of clips, and of what a walk performs.

#include "ecs/base/rng.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/matching/match_root.h"
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
#include <vector>

namespace limn::match_database_test {

using namespace limn::test;

namespace {

constexpr MatchWeights kEven = {1, 1, 1};

/// A stick person's hips go around a circle of `radius` [m] at `rate` [rad/s], to the left; the
/// rest is as at rest.
ClipData make_orbit(float radius, float rate, float duration) {
    ClipData clip;
    clip.name = "orbit";
    clip.duration = duration;
    ClipSheet& sheet = clip.sheets.emplace_back();
    sheet.rotating = {0};
    sheet.translating = {0};
    const auto keys = static_cast<int>(std::lround(duration * 120));
    for (int key = 0; key <= keys; ++key) {
        const float time = duration * static_cast<float>(key) / static_cast<float>(keys);
        const float angle = rate * time;
        sheet.times.push_back(time);
        sheet.rotations.push_back(rotation_about({0, 1, 0}, angle));
        sheet.translations.emplace_back(
            radius * (1 - std::cos(angle)), 0.95f, radius * std::sin(angle));
    }
    return clip;
}

MatchDatabase make_take_database() {
    return make_match_database(make_stick_person(), Assets{}, {}, stick_takes(), kEven);
}

}  // namespace

TEST_CASE(
    "match database: on a circle, features are what geometry says"
    * technique("char.motion-select")) {
    const SkeletonData skeleton = make_stick_person();
    const WalkBody body = find_walk_body(skeleton);
    constexpr float kRadius = 2;
    constexpr float kRate = 0.8f;
    const ClipData clip = make_orbit(kRadius, kRate, 4);
    const auto root = find_clip_root(skeleton, body, clip, kMatchStep);
    const auto rows = find_match_features(skeleton, body, clip, root);
    REQUIRE(rows.size() == 4 * 30 + 1);
    for (std::size_t i = 20; i < rows.size() - 50; ++i) {  // ends are less smooth
        for (std::size_t k = 0; k < 3; ++k) {
            const float angle = kRate * static_cast<float>(k + 1) / 3;
            CHECK(std::abs(rows[i][4 * k] - kRadius * (1 - std::cos(angle))) < 0.01f);
            CHECK(std::abs(rows[i][4 * k + 1] - kRadius * std::sin(angle)) < 0.01f);
            CHECK(std::abs(rows[i][4 * k + 2] - std::sin(angle)) < 0.002f);
            CHECK(std::abs(rows[i][4 * k + 3] - std::cos(angle)) < 0.002f);
        }
        // Feet are where they are at rest, moving with the circle: left inside, right outside.
        const std::array<float, 2> sides = {0.1f, -0.1f};
        for (std::size_t foot = 0; foot < 2; ++foot) {
            CHECK(std::abs(rows[i][12 + 3 * foot] - sides[foot]) < 0.02f);
            CHECK(std::abs(rows[i][13 + 3 * foot] - 0.08f) < 1e-3f);
            CHECK(std::abs(rows[i][20 + 3 * foot] - kRate * (kRadius - sides[foot])) < 0.02f);
        }
        CHECK(std::abs(rows[i][26] - kRate * kRadius) < 0.02f);
        CHECK(std::abs(rows[i][24]) < 0.02f);
    }
}

TEST_CASE("match database: only frames that a second of the same clip follows are searched") {
    Assets assets;
    assets.clips = {make_orbit(1, 0.5f, 2), make_orbit(2, -0.5f, 0.95f), make_orbit(2, 1, 3)};
    const std::vector<ClipId> clips = {{0}, {1}, {2}, {9}};
    const MatchDatabase made = make_match_database(make_stick_person(), assets, clips, {}, kEven);
    REQUIRE(made.clips.size() == 2);
    CHECK(made.rows.count == 31 + 61);
    for (std::uint32_t row = 0; row < made.rows.count; ++row) {
        const MatchPlace place = made.place_of(row);
        CHECK(place.time + 1 <= made.clips[place.clip].duration + 1e-4f);
        CHECK(made.frame_at(place) == made.rows.row(row));
    }
    CHECK(made.clips[0].frames.size() == 61);
    CHECK(made.clips[1].clip == ClipId{2});
}

TEST_CASE("match database: each feature has a mean of 0 and a spread of its weight") {
    const MatchDatabase made = make_match_database(
        make_stick_person(), Assets{}, {}, stick_takes(), {.trajectory = 1, .feet = 2, .hips = 3});
    for (std::size_t part = 0; part < kMatchFeatureParts.size(); ++part) {
        const auto [first, count] = kMatchFeatureParts[part];
        double variance = 0;
        for (std::size_t k = first; k < first + count; ++k) {
            double sum = 0;
            double squares = 0;
            for (std::size_t i = 0; i < made.rows.count; ++i) {
                const auto number = static_cast<double>(made.rows.row(i)[k]);
                sum += number / static_cast<double>(made.rows.count);
                squares += number * number / static_cast<double>(made.rows.count);
            }
            CHECK(std::abs(sum) < 1e-2);
            variance += squares / static_cast<double>(count);
        }
        const double weight = part < 6 ? 1 : part < 10 ? 2 : 3;
        CHECK(std::abs(std::sqrt(variance) - weight) < 0.01 * weight);
    }
}

TEST_CASE("match takes: feet do not move in their contacts, and they have what is wanted") {
    const SkeletonData skeleton = make_stick_person();
    const WalkBody body = find_walk_body(skeleton);
    LocalPose pose;
    float slide = 0;
    float lowest = 1;
    float fastest = 0;
    float sharpest = 0;
    float length = 0;
    for (const MatchTake& take : stick_takes()) {
        REQUIRE(check_clip(take.clip, skeleton.joints.size(), 0).ok());
        REQUIRE(take.root.size() == take.clip.sheets[0].times.size());
        length += take.clip.duration;
        for (const ClipContact& contact : take.clip.contacts) {
            const WalkLeg& leg = body.legs[contact.joint == body.legs[0].foot ? 0 : 1];
            Vec3 heel{};
            Vec3 ball{};
            float way = 0;
            for (const float time : take.clip.sheets[0].times) {
                if (time < contact.begin || time > contact.end) {
                    continue;
                }
                sample_pose(skeleton, &take.clip, time, pose, {});
                const JointPlace foot = find_place(skeleton, pose, leg.foot);
                const Vec3 heel_now = foot.position + foot.rotation * (leg.heel - leg.ankle);
                const Vec3 ball_now = foot.position + foot.rotation * (leg.ball - leg.ankle);
                if (time > contact.begin) {  // it rolls over one of them
                    way += std::min(glm::distance(heel, heel_now), glm::distance(ball, ball_now));
                }
                heel = heel_now;
                ball = ball_now;
                lowest = std::min(lowest, find_place(skeleton, pose, body.hips).position.y);
            }
            slide = std::max(slide, way);
        }
        for (std::size_t i = 30; i < take.root.size(); ++i) {
            const GroundMove move = compose(inverse(take.root[i - 30]), take.root[i]);
            fastest = std::max(fastest, 2 * glm::length(move.way));
            sharpest = std::max(sharpest, 2 * std::abs(move.yaw));
        }
    }
    CHECK(slide < 0.003f);  // the whole way in a contact: of the walk itself
    CHECK(lowest > 0.79f * body.hips_place.y - 1e-3f);  // as it brakes
    CHECK(length > 120);
    CHECK(fastest > 3.5f);
    CHECK(sharpest > 1.8f);
}

TEST_CASE("match database: boxes and vectors find what comparing all rows finds") {
    const MatchDatabase made = make_take_database();
    REQUIRE(made.rows.count > 3000);
    Random random(3, 0, name_hash("match database"), 0);
    for (int i = 0; i < 100; ++i) {
        const auto at =
            static_cast<std::size_t>(random.uniform(0, static_cast<float>(made.rows.count) - 1));
        MatchRow query = made.rows.row(at);
        for (float& number : query) {
            number += random.uniform(-0.7f, 0.7f);
        }
        const RowMatch exact = find_nearest_row_scalar(made.rows, query);
        CHECK(exact.row != kNoMatch);
        CHECK(find_nearest_row(made.rows, query) == exact);
        CHECK(find_nearest_row_boxes(made.rows, query) == exact);
        CHECK(find_nearest_row_boxes(made.rows, query, exact.distance).row == kNoMatch);
    }
}

TEST_CASE("match root: it reaches the wanted speed and heading, whatever the step") {
    for (const float dt : {1.0f / 240, 1.0f / 30}) {
        MatchRoot root;
        const MatchWish wish = {.velocity = {2, 0}};
        for (int i = 0; i < static_cast<int>(4 / dt); ++i) {
            step_match_root(wish, dt, root);
        }
        CHECK(glm::distance(root.velocity, Vec2(2, 0)) < 0.01f);
        CHECK(std::abs(root.heading - 0.5f * kPi) < 0.02f);
    }
    MatchRoot crab;
    for (int i = 0; i < 240; ++i) {
        step_match_root({.velocity = {1, 0}, .facing = {0, 3}}, 1.0f / 60, crab);
    }
    CHECK(glm::distance(crab.velocity, Vec2(1, 0)) < 0.01f);
    CHECK(std::abs(crab.heading) < 1e-3f);
}

}  // namespace limn::match_database_test
