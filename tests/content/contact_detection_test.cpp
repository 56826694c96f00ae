#include "bench/oracles/walker_motion.h"
#include "content/bake/motion/contact_detection.h"
#include "content/bake/motion/flight_curve.h"
#include "content/bake/motion/loop_finding.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::contact_detection_test {

using test::near;

namespace {

std::vector<std::uint16_t> ankles_of(const SkeletonData& skeleton) {
    const BodyJoints body = find_body_joints(skeleton);
    return {body[BodyPart::LeftFoot], body[BodyPart::RightFoot]};
}

std::vector<ClipContact> contacts_of(const oracle::RecordedWalk& walk, float noise = 0) {
    MotionFrames frames = sample_frames(walk.motion, 60);
    Random random(1, 2, 3, 4);
    for (std::size_t f = 0; f < frames.frames() && noise > 0; ++f) {
        frames.translations[f * frames.joints] += noise * random.direction();
    }
    ContactOptions sharp;
    sharp.cutoff = noise > 0 ? 8.0f : 0.0f;
    return detect_contacts(walk.motion.skeleton, frames, ankles_of(walk.motion.skeleton), sharp);
}

/// A foot on its own, at these heights and speeds along z; 60 frames per second.
std::vector<ClipContact> contacts_of_foot(
    const std::vector<float>& heights, const std::vector<float>& speeds,
    const ContactOptions& options) {
    SkeletonData skeleton;
    skeleton.joints = {"root", "LeftFoot"};
    skeleton.parents = {-1, 0};
    skeleton.rest = {{Vec3(0), Vec3(0)}, {Quat(1, 0, 0, 0), Quat(1, 0, 0, 0)}, {Vec3(1), Vec3(1)}};
    MotionFrames frames;
    frames.rate = 60;
    frames.joints = 2;
    float z = 0;
    for (std::size_t f = 0; f < heights.size(); ++f) {
        z += speeds[f] / frames.rate;
        frames.translations.insert(frames.translations.end(), {Vec3(0), Vec3(0, heights[f], z)});
        frames.rotations.insert(frames.rotations.end(), 2, Quat(1, 0, 0, 0));
        frames.scales.insert(frames.scales.end(), 2, Vec3(1));
    }
    const std::vector<std::uint16_t> joints = {1};
    return detect_contacts(skeleton, frames, joints, options);
}

}  // namespace

TEST_CASE(
    "contacts: a foot that rests high above its lowest point is in the air"
    * technique("char.walk-retarget")) {
    std::vector<float> heights(120, 0.0f);
    std::fill(heights.begin() + 40, heights.begin() + 80, 0.4f);
    const auto contacts =
        contacts_of_foot(heights, std::vector<float>(120, 0.0f), {.cutoff = 0.0f});
    REQUIRE(contacts.size() == 2);
    CHECK(contacts[0].end < 40.0f / 60);
    CHECK(contacts[1].begin > 79.0f / 60);
}

TEST_CASE(
    "contacts: once planted a foot may move faster than it may land"
    * technique("char.walk-retarget")) {
    const float threshold = 0.25f * 0.85f;  // of a leg that is not known
    std::vector<float> speeds(120, 2.0f);
    for (std::size_t f = 30; f < 90; ++f) {
        speeds[f] = threshold * (f % 20 < 10 ? 0.7f : 1.3f);
    }
    const std::vector<float> heights(120, 0.0f);
    CHECK(contacts_of_foot(heights, speeds, {.cutoff = 0.0f}).size() == 1);
    CHECK(contacts_of_foot(heights, speeds, {.release = 1.0f, .cutoff = 0.0f}).size() == 3);
}

TEST_CASE(
    "contacts: the plants of a walk are found within a frame or two"
    * technique("char.walk-retarget")) {
    for (const float size : {0.5f, 1.0f, 3.0f}) {
        SkeletonData skeleton = oracle::make_walker();
        for (Vec3& t : skeleton.rest.translations) {
            t *= size;
        }
        const oracle::RecordedWalk walk = oracle::make_walk(skeleton, 3, 0.1f * size);
        const std::vector<ClipContact> contacts = contacts_of(walk);
        REQUIRE(contacts.size() == walk.plants.size());
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            CHECK(contacts[i].joint == walk.plants[i].joint);
            // The eased flight begins and ends slowly: its first and last frames are still planted.
            CHECK(std::abs(contacts[i].begin - walk.plants[i].begin) <= 3.01f / 60);
            CHECK(std::abs(contacts[i].end - walk.plants[i].end) <= 3.01f / 60);
            CHECK(contacts[i].begin <= walk.plants[i].begin + 0.51f / 60);
            CHECK(contacts[i].end >= walk.plants[i].end - 0.51f / 60);
        }
    }
}

TEST_CASE("contacts: noise neither makes nor breaks them" * technique("char.walk-retarget")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    CHECK(contacts_of(walk, 0.002f).size() == walk.plants.size());
    CHECK(contacts_of(walk, 0.004f).size() == walk.plants.size());
}

TEST_CASE(
    "contacts: a body at rest stands, one that falls does not" * technique("char.walk-retarget")) {
    oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker(), 1);
    const SkeletonData& skeleton = walk.motion.skeleton;
    walk.motion.clip.sheets.clear();
    MotionFrames frames = sample_frames(walk.motion, 60);
    const auto contacts = detect_contacts(skeleton, frames, ankles_of(skeleton));
    REQUIRE(contacts.size() == 2);
    CHECK(contacts[0].begin == 0);
    CHECK(contacts[0].end == near(1));
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        frames.translations[f * frames.joints].y -= 0.05f * static_cast<float>(f);
    }
    CHECK(detect_contacts(skeleton, frames, ankles_of(skeleton)).empty());
}

TEST_CASE(
    "travel: a walk on the spot goes as far as its feet go back"
    * technique("char.walk-retarget")) {
    const oracle::RecordedWalk walk =
        oracle::make_walk(oracle::make_walker({.has_bone_axes = true}));
    MotionFrames frames = sample_frames(walk.motion, 60);
    const MotionFrames original = frames;
    const std::size_t joints = frames.joints;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        frames.translations[f * joints].z = frames.translations[0].z;
    }
    const float distance = add_travel(walk.motion.skeleton, frames);
    CHECK(distance == near(3 * static_cast<double>(walk.stride)).epsilon(0.02));
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        CHECK(
            glm::distance(frames.translations[f * joints], original.translations[f * joints])
            < 0.05f);
    }
}

TEST_CASE(
    "flight curve: a walk returns its own flight, forward and up"
    * technique("char.walk-retarget, char.foot-flight")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    const MotionFrames frames = sample_frames(walk.motion, 60);
    const std::vector<FlightCurve> flights =
        extract_flights(walk.motion.skeleton, frames, walk.plants, 25);
    CHECK(flights.size() == walk.plants.size() - 2);  // each foot
    for (const FlightCurve& flight : flights) {
        if (flight.begin < 0.1f || flight.end > 2.9f) {
            continue;  // cut off
        }
        CHECK(flight.length == near(static_cast<double>(walk.stride)).epsilon(1e-3));
        CHECK(flight.height == near(static_cast<double>(walk.lift)).epsilon(0.01));
        CHECK(flight.end - flight.begin == near(0.4));
        for (float u = 0; u <= 1; u += 0.05f) {
            const Vec2 point = sample_flight(flight, u);
            CHECK(point.x == near(static_cast<double>(u * u * (3 - 2 * u))).scale(1).epsilon(0.01));
            CHECK(
                point.y
                == near(16 * static_cast<double>(u * u * (1 - u) * (1 - u)))
                       .scale(1)
                       .epsilon(0.01));
        }
    }
    // From contacts that were detected: plants within three frames, height within 1 %.
    const auto detected = extract_flights(walk.motion.skeleton, frames, contacts_of(walk));
    REQUIRE(detected.size() == flights.size());
    CHECK(detected[1].height == near(static_cast<double>(walk.lift)).epsilon(0.01));
}

TEST_CASE(
    "flight curve: on other legs lengths and heights scale with the legs"
    * technique("char.walk-retarget")) {
    SkeletonData skeleton = oracle::make_walker();
    for (Vec3& t : skeleton.rest.translations) {
        t *= 1.7f;
    }
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    const oracle::RecordedWalk large = oracle::make_walk(skeleton, 3, 0.1f * 1.7f);
    const auto small_flights =
        extract_flights(walk.motion.skeleton, sample_frames(walk.motion, 60), walk.plants);
    const auto large_flights =
        extract_flights(skeleton, sample_frames(large.motion, 60), large.plants);
    REQUIRE(small_flights.size() == large_flights.size());
    for (std::size_t i = 1; i + 1 < small_flights.size(); ++i) {
        CHECK(
            large_flights[i].length
            == near(1.7 * static_cast<double>(small_flights[i].length)).epsilon(1e-3));
        for (std::size_t k = 0; k < small_flights[i].points.size(); ++k) {
            CHECK(glm::distance(small_flights[i].points[k], large_flights[i].points[k]) < 1e-3f);
        }
    }
}

TEST_CASE(
    "loop: the best interval of a walk is a whole number of cycles, and has no seam"
    * technique("char.mocap-cleanup")) {
    const oracle::RecordedWalk walk =
        oracle::make_walk(oracle::make_walker({.has_bone_axes = true}), 3.4f);
    const SkeletonData& skeleton = walk.motion.skeleton;
    MotionFrames frames = sample_frames(walk.motion, 60);
    const auto loop = find_loop(skeleton, frames, 0.4f, 1.5f);
    REQUIRE(loop.has_value());
    CHECK(loop->last - loop->first == 60);
    CHECK(loop->error < 1e-3f);
    // A drift, which the seam closes.
    const std::uint16_t arm = find_body_joints(skeleton)[BodyPart::LeftUpperArm];
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        Quat& q = frames.rotations[f * frames.joints + arm];
        q = q * rotation_about({1, 0, 0}, 0.002f * static_cast<float>(f));
        frames.translations[f * frames.joints].y += 0.001f * static_cast<float>(f);
    }
    const MotionFrames cut = cut_loop(skeleton, frames, *loop);
    CHECK(cut.frames() == 61);
    const std::size_t end = 60 * cut.joints;
    for (std::size_t j = 0; j < cut.joints; ++j) {
        CHECK(std::abs(glm::dot(cut.rotations[j], cut.rotations[end + j])) > 1 - 1e-6f);
        if (j > 0) {
            CHECK(glm::distance(cut.translations[j], cut.translations[end + j]) < 1e-5f);
        }
    }
    CHECK(cut.translations[end].y == near(static_cast<double>(cut.translations[0].y)));
    CHECK(
        cut.translations[end].z - cut.translations[0].z
        == near(static_cast<double>(walk.stride)).epsilon(1e-3));
    CHECK(!find_loop(skeleton, frames, 100).has_value());
    // So many frames that not all pairs are compared: the period, 14 frames, is found all the same.
    MotionFrames many;
    many.rate = 24;
    many.joints = frames.joints;
    for (std::size_t f = 0; f < 4000; ++f) {
        const std::size_t from = (f % 14) * 4 * frames.joints;
        const auto copy = [&](const auto& source, auto& target) {
            const auto first = source.begin() + static_cast<std::ptrdiff_t>(from);
            target.insert(target.end(), first, first + static_cast<std::ptrdiff_t>(frames.joints));
        };
        copy(frames.translations, many.translations);
        copy(frames.rotations, many.rotations);
        copy(frames.scales, many.scales);
    }
    const auto found = find_loop(skeleton, many, 0.4f, 0);
    REQUIRE(found.has_value());
    CHECK(found->last - found->first == 14);
    CHECK(found->error < 1e-4f);
}

}  // namespace limn::contact_detection_test
