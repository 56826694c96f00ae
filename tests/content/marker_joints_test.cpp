#include "bench/oracles/walker_motion.h"
#include "content/bake/motion/marker_joints.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace limn::marker_joints_test {
namespace {

/// Markers around the joints of a walker, `per_joint` on each that has some.
struct Take {
    oracle::RecordedWalk walk;
    std::vector<BodyMarker> markers;
    MarkerMotion motion;
};

Take make_take(std::size_t per_joint, const oracle::WalkerShape& shape = {}) {
    Take take{oracle::make_walk(oracle::make_walker(shape), 1), {}, {}};
    const SkeletonData& skeleton = take.walk.motion.skeleton;
    const std::vector<Affine> rest = find_rest_matrices(skeleton);
    Random random(1, 2, 3, 4);
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        for (std::size_t m = 0; m < per_joint; ++m) {
            take.markers.push_back(
                {static_cast<std::uint16_t>(j),
                 transform_point(rest[j], Vec3(0)) + 0.1f * random.direction()});
            take.motion.names.push_back("m" + std::to_string(take.markers.size()));
        }
    }
    const MotionFrames frames = sample_frames(take.walk.motion, 60);
    take.motion.rate = 60;
    for (std::size_t f = 0; f < frames.frames(); ++f) {
        const std::vector<Affine> now = find_frame_joints(skeleton, frames, f);
        for (const BodyMarker& marker : take.markers) {
            const Affine back = to_affine(glm::inverse(to_mat4(rest[marker.joint])));
            take.motion.positions.push_back(
                transform_point(now[marker.joint], transform_point(back, marker.position)));
        }
    }
    return take;
}

/// Largest difference of a component of a local rotation, of all joints and frames.
float largest_difference(const MotionFrames& a, const MotionFrames& b, std::size_t first = 0) {
    REQUIRE(a.rotations.size() == b.rotations.size());
    float largest = 0;
    for (std::size_t i = 0; i < a.rotations.size(); ++i) {
        if (i % a.joints >= first) {
            const Quat difference =
                to_same_hemisphere(a.rotations[i], b.rotations[i]) - a.rotations[i];
            largest = std::max(largest, glm::length(difference));
        }
    }
    return largest;
}

MarkerFit fitted(const Take& take) {
    const Result<MarkerFit> fit = fit_markers(take.walk.motion.skeleton, take.markers, take.motion);
    REQUIRE_MESSAGE(fit.ok(), (fit ? "" : fit.error().message));
    return *fit;
}

}  // namespace

TEST_CASE(
    "markers to joints: markers of a pose give its rotations to 1e-5"
    * technique("char.marker-to-joint")) {
    for (const bool has_axes : {false, true}) {
        const Take take = make_take(4, {.has_bone_axes = has_axes});
        const MarkerFit fit = fitted(take);
        const MotionFrames expected = sample_frames(take.walk.motion, 60);
        CHECK(largest_difference(fit.frames, expected) < 1e-5f);
        CHECK(fit.residual < 1e-6f);
        for (std::size_t f = 0; f < expected.frames(); ++f) {
            const std::size_t root = f * expected.joints;
            CHECK(
                glm::distance(fit.frames.translations[root], expected.translations[root]) < 1e-5f);
            CHECK(fit.frames.translations[root + 1] == expected.translations[root + 1]);
        }
    }
}

TEST_CASE(
    "markers to joints: a rigid motion of all changes the root only"
    * technique("char.marker-to-joint")) {
    Take take = make_take(4);
    const MarkerFit fit = fitted(take);
    const Affine moved = affine_from({3, 1, -2}, rotation_about({1, 2, 3}, 2), Vec3(1));
    for (Vec3& p : take.motion.positions) {
        p = transform_point(moved, p);
    }
    const MarkerFit turned = fitted(take);
    CHECK(largest_difference(fit.frames, turned.frames, 1) < 2e-5f);
    CHECK(largest_difference(fit.frames, turned.frames) > 0.1f);
}

TEST_CASE(
    "markers to joints: few or collinear markers turn the joint without twist"
    * technique("char.marker-to-joint")) {
    Take take = make_take(3);
    const SkeletonData& skeleton = take.walk.motion.skeleton;
    const std::uint16_t arm = find_body_joints(skeleton)[BodyPart::LeftUpperArm];
    const std::vector<Affine> rest = find_rest_matrices(skeleton);
    const Vec3 shoulder = transform_point(rest[arm], Vec3(0));
    // Three markers in a line along the arm, which swings about z and does not twist.
    const MotionFrames expected = sample_frames(take.walk.motion, 60);
    float step = 0.05f;
    for (std::size_t m = 0; m < take.markers.size(); ++m) {
        if (take.markers[m].joint != arm) {
            continue;
        }
        take.markers[m].position = shoulder + Vec3(step, 0, 0);
        for (std::size_t f = 0; f < expected.frames(); ++f) {
            const Affine now = find_frame_joints(skeleton, expected, f)[arm];
            take.motion.positions[f * take.motion.markers() + m] =
                transform_point(now, Vec3(step, 0, 0));
        }
        step += 0.1f;
    }
    const MarkerFit fit = fitted(take);
    CHECK(largest_difference(fit.frames, expected) < 1e-4f);
}

TEST_CASE(
    "markers to joints: without markers of its own a joint moves with its parent"
    * technique("char.marker-to-joint")) {
    Take take = make_take(4);
    const SkeletonData& skeleton = take.walk.motion.skeleton;
    const std::uint16_t head = find_body_joints(skeleton)[BodyPart::Head];
    for (std::size_t m = 0; m < take.markers.size(); ++m) {
        if (take.markers[m].joint == head) {
            take.markers[m].joint = BodyMarker::kUnused;
        }
    }
    const std::size_t hidden = 40 * take.motion.markers();  // and one that is not seen
    take.motion.positions[hidden] = Vec3(std::numeric_limits<float>::quiet_NaN());
    const MarkerFit fit = fitted(take);
    CHECK(fit.frames.rotations[head] == skeleton.rest.rotations[head]);
    CHECK(largest_difference(fit.frames, sample_frames(take.walk.motion, 60)) < 1e-5f);
    for (BodyMarker& marker : take.markers) {
        marker.joint = BodyMarker::kUnused;
    }
    const Result<MarkerFit> none = fit_markers(skeleton, take.markers, take.motion);
    REQUIRE(!none.ok());
    CHECK(none.error().message == "found no marker of a joint, expected at least one");
}

TEST_CASE(
    "markers to joints: markers that slide on the skin leave a residual"
    * technique("char.marker-to-joint")) {
    Take take = make_take(4);
    Random random(5, 6, 7, 8);
    for (Vec3& p : take.motion.positions) {
        p += 0.01f * random.direction();
    }
    const MarkerFit fit = fitted(take);
    const SkeletonData& skeleton = take.walk.motion.skeleton;
    const std::vector<Affine> rest = find_rest_matrices(skeleton);
    double squares = 0;
    for (std::size_t f = 0; f < fit.frames.frames(); ++f) {  // by the joints that were found
        const std::vector<Affine> now = find_frame_joints(skeleton, fit.frames, f);
        for (std::size_t m = 0; m < take.markers.size(); ++m) {
            const BodyMarker& marker = take.markers[m];
            const Affine back = to_affine(glm::inverse(to_mat4(rest[marker.joint])));
            const Vec3 at =
                transform_point(now[marker.joint], transform_point(back, marker.position));
            const Vec3 off = at - take.motion.positions[f * take.markers.size() + m];
            squares += static_cast<double>(glm::dot(off, off));
        }
    }
    const double count = static_cast<double>(take.motion.positions.size());
    CHECK(
        std::sqrt(squares / count) == test::near(static_cast<double>(fit.residual)).epsilon(1e-3));
    CHECK(fit.residual > 0.003f);
    CHECK(fit.residual < 0.04f);  // the noise of a joint moves all below it
    CHECK(largest_difference(fit.frames, sample_frames(take.walk.motion, 60)) < 0.5f);
}

}  // namespace limn::marker_joints_test
