#include "ecs/base/rng.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_kernels.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace limn::clip_sampling_test {

using namespace limn::test;

namespace {

float apart(const Quat& a, const Quat& b) {
    return std::min(glm::length(a - b), glm::length(a + b));
}
float apart(const Vec3& a, const Vec3& b) {
    return glm::length(a - b);
}

LocalPose sampled(const ClipData& clip, const SkeletonData& skeleton, float time) {
    LocalPose pose = skeleton.rest;
    sample_clip(clip, time, pose, {});
    return pose;
}

float angle_at(const ClipData& clip, float time) {
    const SkeletonData skeleton = make_chain(2);
    return degrees(axis_angle(sampled(clip, skeleton, time).rotations[1]).angle);
}

Quat any_rotation(Random& random) {
    return normalize_or_identity(
        Quat(random.normal(), random.normal(), random.normal(), random.normal()));
}

}  // namespace

TEST_CASE(
    "clip: keys are found before, between, at and after their times, and for NaN"
    * technique("anim.key-lookup")) {
    const std::vector<float> times = {0, 1, 4};
    const auto is_at = [&](float t, std::size_t first, float u) {
        const KeyInterval interval = find_keys(times, t);
        return interval.first == first && interval.u == u;
    };
    CHECK(is_at(2.5f, 1, 0.5f));
    CHECK(is_at(0, 0, 0));
    CHECK(is_at(1, 1, 0));
    CHECK(is_at(4, 1, 1));
    CHECK(is_at(9, 1, 1));
    CHECK(is_at(-1, 0, 0));
    CHECK(is_at(NAN, 0, 0));
    CHECK(find_keys(std::vector<float>{3}, 7).first == 0);
    CHECK(find_keys(std::vector<float>{3}, 7).u == 0);
    Random random(1, 0, 0, 0);
    std::vector<float> many;
    float now = 0;
    for (int i = 0; i < 1000; ++i) {
        many.push_back(now += random.uniform(0.001f, 1.0f));
    }
    for (int i = 0; i < 10'000; ++i) {
        const float t = random.uniform(-1.0f, now + 1);
        const KeyInterval interval = find_keys(many, t);
        CHECK(interval.u >= 0);
        CHECK(interval.u <= 1);
        CHECK((t < many[0] || many[interval.first] <= t));
        CHECK((t >= many.back() || t < many[interval.first + 1]));
    }
}

TEST_CASE("clip: time wraps around at the end, or stays there" * technique("char.pose-eval")) {
    CHECK(clip_time(2, 5, true) == 1);
    CHECK(clip_time(2, -0.5f, true) == 1.5f);
    CHECK(clip_time(2, 5, false) == 2);
    CHECK(clip_time(2, -1, false) == 0);
    CHECK(clip_time(0, 5, true) == 0);
    CHECK(clip_time(2, NAN, true) == 0);
    CHECK(clip_time(2, INFINITY, true) == 0);
    CHECK(clip_time(2, -1e-30f, true) <= 2);
}

TEST_CASE(
    "clip: at a key the pose is the key, between keys it rotates at constant speed"
    * technique("char.pose-eval")) {
    const ClipData clip = make_turn({0, 1, 3}, {0, 90, 100}, 1);
    REQUIRE(check_clip(clip, 2, 0).ok());
    for (std::size_t i = 0; i < 3; ++i) {
        const LocalPose pose = sampled(clip, make_chain(2), clip.sheets[0].times[i]);
        CHECK(apart(pose.rotations[1], clip.sheets[0].rotations[i]) < 3e-7f);
    }
    const Quat quarter = sampled(clip, make_chain(2), 0.25f).rotations[1];
    CHECK(glm::length(quarter - Quat(0.980785f, 0, 0, 0.195090f)) < 1e-6f);
    for (int k = 0; k <= 20; ++k) {
        const float t = static_cast<float>(k) / 20;
        CHECK(angle_at(clip, t) == test::near(90 * t).epsilon(1e-5));
        CHECK(angle_at(clip, 1 + 2 * t) == test::near(90 + 10 * t).epsilon(1e-5));
    }
    CHECK(angle_at(clip, -1) == test::near(0).scale(1));
    CHECK(angle_at(clip, 99) == test::near(100).epsilon(1e-5));
}

TEST_CASE(
    "clip: samples at 30 Hz are shown at 100 Hz, none lost and at even speed"
    * technique("anim.mocap-keys")) {
    std::vector<float> times;
    std::vector<float> angles;
    for (int i = 0; i <= 30; ++i) {
        times.push_back(static_cast<float>(i) / 30);
        angles.push_back(3.0f * static_cast<float>(i));  // 90 deg/s
    }
    const ClipData spin = make_turn(times, angles, 1);
    for (int k = 0; k <= 100; ++k) {
        const float t = static_cast<float>(k) / 100;
        CHECK(std::abs(angle_at(spin, t) - 90 * t) < 1e-4f);
    }
    // Any motion: met at the times that both have, and never faster than between two samples.
    ClipData motion = spin;
    std::vector<Quat>& keys = motion.sheets[0].rotations;
    Random random(3, 0, name_hash("samples"), 0);
    for (std::size_t i = 1; i < keys.size(); ++i) {
        const Quat step = rotation_about(random.direction(), random.uniform(0, 0.4f));
        keys[i] = to_same_hemisphere(keys[i - 1], keys[i - 1] * step);
    }
    const auto angle_between = [](const Quat& a, const Quat& b) {
        return 2 * std::asin(std::min(0.5f * apart(a, b), 1.0f)) * 2;
    };
    float largest_step = 0;
    for (std::size_t i = 1; i < keys.size(); ++i) {
        largest_step = std::max(largest_step, angle_between(keys[i - 1], keys[i]));
    }
    Quat last = keys[0];
    for (int k = 0; k <= 100; ++k) {
        const Quat shown = sampled(motion, make_chain(2), static_cast<float>(k) / 100).rotations[1];
        CHECK(angle_between(last, shown) <= largest_step + 1e-6f);
        if (k % 10 == 0) {
            CHECK(apart(shown, keys[static_cast<std::size_t>(k / 10 * 3)]) < 2e-6f);
        }
        last = shown;
    }
}

TEST_CASE(
    "clip: the sign of a key does not matter, and joints rotate independently"
    * technique("anim.mocap-keys, char.pose-eval")) {
    Random random(5, 0, 0, 0);
    for (const std::size_t count : {1u, 2u, 7u, 8u, 23u, 64u, 65u, 200u}) {
        ClipSheet sheet;
        sheet.times = {0, 2};
        for (std::size_t i = 0; i < 2 * count; ++i) {
            sheet.rotations.push_back(any_rotation(random));
        }
        for (std::size_t i = 0; i < count; ++i) {
            sheet.rotating.push_back(static_cast<std::uint16_t>(count - 1 - i));
        }
        ClipData clip{"any", 2, {sheet}};
        const SkeletonData skeleton = make_chain(count);
        REQUIRE(check_clip(clip, count, 0).ok());
        const LocalPose pose = sampled(clip, skeleton, 0.6f);
        for (std::size_t i = 0; i < count; ++i) {
            const Quat expected = slerp(sheet.rotations[i], sheet.rotations[count + i], 0.3f);
            const Quat& found = pose.rotations[count - 1 - i];
            CHECK(apart(found, expected) < 2e-6f);
            CHECK(glm::length(found) == test::near(1).epsilon(1e-6));
        }
        for (std::size_t i = count; i < 2 * count; i += 2) {
            clip.sheets[0].rotations[i] = -clip.sheets[0].rotations[i];
        }
        const LocalPose again = sampled(clip, skeleton, 0.6f);
        for (std::size_t i = 0; i < count; ++i) {
            CHECK(apart(again.rotations[i], pose.rotations[i]) < 1e-6f);
        }
    }
}

TEST_CASE("clip: SIMD and plain C++ give the same bits" * technique("char.pose-eval")) {
    Random random(6, 0, 0, 0);
    std::vector<Quat> from;
    std::vector<Quat> to;
    for (int i = 0; i < 1003; ++i) {
        from.push_back(any_rotation(random));
        // Equal, opposite, half a turn away, a little and much turned.
        const Quat other = rotation_about(random.direction(), random.uniform(0.0f, 1e-3f));
        to.push_back(
            i % 5 == 0   ? from.back()
            : i % 5 == 1 ? -from.back()
            : i % 5 == 2 ? from.back() * rotation_about(random.direction(), kPi)
            : i % 5 == 3 ? from.back() * other
                         : any_rotation(random));
    }
    for (const float u : {0.0f, 0.3f, 0.5f, 1.0f}) {
        std::vector<Quat> wide(from.size());
        std::vector<Quat> plain(from.size());
        slerp_rotations(from, to, u, wide);
        slerp_rotations_scalar(from, to, u, plain);
        CHECK(std::memcmp(wide.data(), plain.data(), wide.size() * sizeof(Quat)) == 0);
        for (std::size_t i = 0; i < plain.size(); ++i) {
            CHECK(glm::length(plain[i]) == test::near(1).epsilon(5e-7));
            if (i % 5 != 2) {  // half a turn may go in either direction
                CHECK(apart(plain[i], slerp(from[i], to[i], u)) < 2e-6f);
            }
        }
    }
    std::vector<Quat> in_place = from;
    std::vector<Quat> elsewhere(from.size());
    slerp_rotations(from, to, 0.4f, elsewhere);
    slerp_rotations(in_place, to, 0.4f, in_place);
    CHECK(in_place == elsewhere);
}

TEST_CASE("clip: steps hold, lines are straight, cubics keep their slopes") {
    ClipSheet sheet;
    sheet.times = {1, 2, 4};
    sheet.translating = {1};
    sheet.scaling = {0};
    sheet.morphing = {2};
    const SkeletonData skeleton = make_chain(2);
    const auto at = [&](const ClipSheet& keys, float time) {
        LocalPose pose = skeleton.rest;
        std::vector<float> weights(3, -1.0f);
        sample_clip({"", 4, {keys}}, time, pose, weights);
        CHECK(weights[0] == -1);
        CHECK(pose.translations[0] == Vec3(0));
        CHECK(pose.scales[1] == Vec3(1));
        return Vec3(pose.translations[1].x, pose.scales[0].y, weights[2]);
    };
    const std::vector<float> keys = {2, 10, -6};
    for (const float key : keys) {
        sheet.translations.push_back(Vec3(key));
        sheet.scales.push_back(Vec3(key));
        sheet.weights.push_back(key);
    }
    CHECK(at(sheet, 1.25f) == Vec3(4));
    CHECK(at(sheet, 3) == Vec3(2));
    CHECK(at(sheet, 0) == Vec3(2));
    CHECK(at(sheet, 5) == Vec3(-6));
    sheet.interpolation = Interpolation::Step;
    CHECK(at(sheet, 0) == Vec3(2));
    CHECK(at(sheet, 1.99f) == Vec3(2));
    CHECK(at(sheet, 2) == Vec3(10));
    CHECK(at(sheet, 3.99f) == Vec3(10));
    CHECK(at(sheet, 4) == Vec3(-6));

    // x^3 until 2, a line from there on: each key with its slopes before and after. The first's
    // before and the last's after have no meaning.
    sheet.interpolation = Interpolation::Cubic;
    sheet.translations.clear();
    sheet.scales.clear();
    sheet.weights.clear();
    for (const float value : {77.0f, 1.0f, 3.0f, 12.0f, 8.0f, -12.0f, -12.0f, -16.0f, 99.0f}) {
        sheet.translations.push_back(Vec3(value));
        sheet.scales.push_back(Vec3(value));
        sheet.weights.push_back(value);
    }
    for (const float t : {1.0f, 1.3f, 1.9f, 2.0f, 2.2f, 3.7f, 4.0f}) {
        const float expected = t <= 2 ? t * t * t : 32 - 12 * t;
        CHECK(apart(at(sheet, t), Vec3(expected)) < 1e-4f);
    }
}

TEST_CASE(
    "clip: straight segments hit their keys exactly, are symmetric, and have corners there"
    * technique("anim.lerp")) {
    const auto line = [](const std::vector<float>& keys) {
        ClipSheet sheet;
        sheet.morphing = {0};
        sheet.weights = keys;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            sheet.times.push_back(static_cast<float>(i));
        }
        return [clip = ClipData{"", 0, {sheet}}](float time) {
            LocalPose none;
            float weight = -1;
            sample_clip(clip, time, none, {&weight, 1});
            return weight;
        };
    };
    const auto up = line({2, 10});
    const auto down = line({10, 2});
    CHECK(up(0) == 2);
    CHECK(up(1) == 10);
    CHECK(up(0.25f) == 4);
    for (const float u : {0.125f, 0.5f, 0.75f}) {
        CHECK(up(u) == down(1 - u));
    }
    const auto roof = line({0, 1, 0});
    CHECK(roof(1) - roof(0.75f) == 0.25f);
    CHECK(roof(1.25f) - roof(1) == -0.25f);
}

TEST_CASE("clip: a cubic rotation passes through its keys with length 1") {
    const std::vector<float> angles = {0, 60, 90};
    ClipSheet sheet;
    sheet.interpolation = Interpolation::Cubic;
    sheet.times = {0, 1, 2};
    sheet.rotating = {1};
    for (const float angle : angles) {
        const Quat q = rotation_about({0, 0, 1}, radians(angle));
        const Quat slope = 0.5f * radians(45) * (q * Quat(0, 0, 0, 1));
        sheet.rotations.insert(sheet.rotations.end(), {slope, q, slope});
    }
    const ClipData clip{"cubic", 2, {sheet}};
    REQUIRE(check_clip(clip, 2, 0).ok());
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(angle_at(clip, sheet.times[i]) == test::near(angles[i]).epsilon(1e-5));
    }
    const float speed = (angle_at(clip, 1.001f) - angle_at(clip, 0.999f)) / 0.002f;
    CHECK(speed == test::near(45).epsilon(0.01));
    CHECK(glm::length(sampled(clip, make_chain(2), 0.4f).rotations[1]) == test::near(1));
}

TEST_CASE(
    "clip: without a clip the pose rests, a single key holds" * technique("char.clip-layout")) {
    const SkeletonData skeleton = make_chain(3);
    const LocalPose rest = sampled({}, skeleton, 1);
    CHECK(rest.rotations == skeleton.rest.rotations);
    CHECK(rest.translations == skeleton.rest.translations);
    const ClipData one = make_turn({0.5f}, {30}, 1);
    for (const float time : {0.0f, 0.5f, 2.0f}) {
        CHECK(angle_at(one, time) == test::near(30).epsilon(1e-5));
    }
}

TEST_CASE("clip: m keys of n joints are m (1 + 7 n) numbers" * technique("char.clip-layout")) {
    const auto size_of = [](std::size_t joints, std::size_t keys) {
        ClipSheet sheet;
        sheet.times.resize(keys);
        sheet.rotating.resize(joints);
        sheet.rotations.resize(keys * joints);
        sheet.translating.resize(joints);
        sheet.translations.resize(keys * joints);
        return clip_size({"", 0, {sheet}});
    };
    CHECK(size_of(20, 600) == 84'600);
    CHECK(size_of(98, 1) == 687);
}

TEST_CASE(
    "joints: a matrix is the product from the root on, in the order T R S"
    * technique("char.local-global")) {
    SkeletonData skeleton = make_chain(4);
    std::vector<Affine> matrices(4);
    compute_joint_matrices(skeleton, skeleton.rest, matrices);
    CHECK(transform_point(matrices[3], Vec3(0)) == Vec3(0, 3, 0));
    LocalPose pose = skeleton.rest;
    pose.translations[0] = {5, 0, 0};
    pose.rotations[1] = rotation_about({0, 0, 1}, radians(90));
    pose.scales[1] = {1, 2, 1};
    compute_joint_matrices(skeleton, pose, matrices);
    CHECK(apart(transform_point(matrices[0], Vec3(0)), Vec3(5, 0, 0)) < 1e-6f);
    CHECK(apart(transform_point(matrices[1], Vec3(0)), Vec3(5, 1, 0)) < 1e-6f);
    CHECK(apart(transform_point(matrices[2], Vec3(0)), Vec3(3, 1, 0)) < 1e-6f);
    CHECK(apart(transform_point(matrices[3], Vec3(0)), Vec3(1, 1, 0)) < 1e-6f);
}

TEST_CASE(
    "joints: rotating one moves its descendants and no others, and no bone changes length"
    * technique("char.local-global")) {
    SkeletonData skeleton = make_chain(9);
    skeleton.parents = {-1, 0, 1, 2, 1, 4, 0, 6, 7};
    REQUIRE(check_skeleton(skeleton).ok());
    Random random(9, 0, 0, 0);
    LocalPose pose = skeleton.rest;
    for (Quat& rotation : pose.rotations) {
        rotation = any_rotation(random);
    }
    std::vector<Affine> before(9);
    compute_joint_matrices(skeleton, pose, before);
    pose.rotations[4] = any_rotation(random);
    std::vector<Affine> after(9);
    compute_joint_matrices(skeleton, pose, after);
    for (std::size_t i = 0; i < 9; ++i) {
        const bool moves = i == 4 || i == 5;
        CHECK((std::memcmp(&before[i], &after[i], sizeof(Affine)) != 0) == moves);
        if (i > 0) {
            const std::size_t parent = static_cast<std::size_t>(skeleton.parents[i]);
            const float length =
                apart(transform_point(after[i], Vec3(0)), transform_point(after[parent], Vec3(0)));
            CHECK(length == test::near(1).epsilon(1e-5));
        }
        const float volume = glm::determinant(Mat3(to_mat4(after[i])));
        CHECK(volume == test::near(1).epsilon(1e-6));
    }
}

TEST_CASE(
    "joints: angles are applied in the order of the channels of a file"
    * technique("char.local-global")) {
    // Z 90, X 90, Y 0 as R = Rz Rx Ry; the schematic Rx Ry Rz of the book would give (-1, 0, 0).
    SkeletonData skeleton = make_chain(1);
    LocalPose pose = skeleton.rest;
    pose.rotations[0] =
        rotation_about({0, 0, 1}, radians(90)) * rotation_about({1, 0, 0}, radians(90));
    std::vector<Affine> matrices(1);
    compute_joint_matrices(skeleton, pose, matrices);
    CHECK(apart(transform_vector(matrices[0], Vec3(0, 1, 0)), Vec3(0, 0, 1)) < 1e-6f);
}

}  // namespace limn::clip_sampling_test
