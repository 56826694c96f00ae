#include "content/bake/motion/marker_cleanup.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace limn::marker_cleanup_test {
namespace {

const Vec3 kHidden(std::numeric_limits<float>::quiet_NaN());
using Path = std::function<Vec3(float)>;

MarkerMotion make_motion(std::size_t frames, const std::vector<Path>& paths) {
    MarkerMotion motion;
    motion.rate = 100;
    for (std::size_t m = 0; m < paths.size(); ++m) {
        motion.names.push_back("m" + std::to_string(m));
    }
    for (std::size_t f = 0; f < frames; ++f) {
        for (const Path& path : paths) {
            motion.positions.push_back(path(static_cast<float>(f) / motion.rate));
        }
    }
    return motion;
}

Vec3& at(MarkerMotion& motion, std::size_t frame, std::size_t marker) {
    return motion.positions[frame * motion.markers() + marker];
}

float largest_difference(const MarkerMotion& a, const MarkerMotion& b) {
    float largest = 0;
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
        largest = std::max(largest, glm::distance(a.positions[i], b.positions[i]));
    }
    return largest;
}

Vec3 cubic(float t) {
    return {1 - 2 * t + 3 * t * t - 4 * t * t * t, t, 0.5f - 6 * t * t * t};
}

}  // namespace

TEST_CASE(
    "marker clean-up: a gap of five frames in a cubic is filled to 1e-4"
    * technique("char.mocap-cleanup")) {
    const MarkerMotion whole = make_motion(40, {cubic});
    for (const std::size_t begin : {2, 17, 33}) {
        MarkerMotion motion = whole;
        for (std::size_t f = begin; f < begin + 5; ++f) {
            at(motion, f, 0) = kHidden;
        }
        CHECK(fill_marker_gaps(motion, {}, 5) == 5);
        CHECK(largest_difference(motion, whole) < 1e-4f);
        for (std::size_t f = begin; f < begin + 5; ++f) {
            at(motion, f, 0) = kHidden;
        }
        CHECK(fill_marker_gaps(motion, {}, 4) == 0);
        CHECK(std::isnan(at(motion, begin, 0).x));
    }
}

TEST_CASE(
    "marker clean-up: gaps at the start and the end hold the nearest position"
    * technique("char.mocap-cleanup")) {
    MarkerMotion motion = make_motion(20, {cubic});
    const MarkerMotion whole = motion;
    for (const std::size_t f : {0, 1, 2, 18, 19}) {
        at(motion, f, 0) = kHidden;
    }
    CHECK(fill_marker_gaps(motion, {}, 10) == 5);
    CHECK(at(motion, 0, 0) == whole.positions[3]);
    CHECK(at(motion, 19, 0) == whole.positions[17]);
    MarkerMotion none = make_motion(5, {[](float) { return kHidden; }});
    CHECK(fill_marker_gaps(none, {}, 10) == 0);
}

TEST_CASE(
    "marker clean-up: a marker of a solid body moves with the others"
    * technique("char.mocap-cleanup")) {
    std::vector<Path> paths;
    for (const Vec3& rest :
         {Vec3(0.1f, 0, 0), Vec3(0, 0.2f, 0), Vec3(0, 0, 0.1f), Vec3(0.1f, 0.1f, 0.1f)}) {
        paths.emplace_back([rest](float t) {
            return rotation_about({1, 2, 0.5f}, 20 * t) * rest + Vec3(std::sin(9 * t), t, 0);
        });
    }
    const MarkerMotion whole = make_motion(80, paths);
    MarkerMotion motion = whole;
    for (std::size_t f = 20; f < 60; ++f) {
        at(motion, f, 3) = kHidden;
    }
    MarkerMotion alone = motion;
    const std::vector<MarkerSegment> segments = {{0, 1, 2, 3}};
    CHECK(fill_marker_gaps(motion, segments, 50) == 40);
    CHECK(largest_difference(motion, whole) < 1e-4f);
    fill_marker_gaps(alone, {}, 50);
    CHECK(largest_difference(alone, whole) > 0.05f);  // what the segment is for
}

TEST_CASE(
    "marker clean-up: labels exchanged while two markers cross are restored"
    * technique("char.mocap-cleanup")) {
    const MarkerMotion whole = make_motion(
        100, {[](float t) { return Vec3(t - 0.5f, 0.03f, 0); },
              [](float t) { return Vec3(0.5f - t, -0.03f, 0); },
              [](float t) { return Vec3(0, 0.5f + 0.1f * std::sin(9 * t), 0); }});
    for (const std::size_t count : {1, 2, 7, 60}) {
        MarkerMotion motion = whole;
        for (std::size_t f = 38; f < 38 + count; ++f) {
            std::swap(at(motion, f, 0), at(motion, f, 1));
        }
        CHECK(restore_swaps(motion, 0.02f) == count);
        CHECK(largest_difference(motion, whole) == 0);
    }
    MarkerMotion right = whole;
    CHECK(restore_swaps(right, 0.02f) == 0);
    CHECK(largest_difference(right, whole) == 0);
}

TEST_CASE(
    "marker clean-up: noise does not exchange labels, and is reduced"
    * technique("char.mocap-cleanup")) {
    const std::vector<Path> paths = {
        [](float t) { return Vec3(std::sin(3 * t), std::cos(3 * t), 0); },
        [](float t) { return Vec3(std::sin(3 * t), std::cos(3 * t), 0.05f); }};
    const MarkerMotion whole = make_motion(200, paths);
    MarkerMotion motion = whole;
    Random random(1, 2, 3, 4);
    for (Vec3& p : motion.positions) {
        p += 0.003f * random.direction();
    }
    at(motion, 50, 0) = kHidden;
    MarkerMotion noisy = motion;
    noisy.positions[100] = whole.positions[100];
    const CleanupCounts counts = clean_markers(motion, {}, {});
    CHECK(counts.swaps == 0);
    CHECK(counts.filled == 1);
    CHECK(counts.unfilled == 0);
    float before = 0;
    float after = 0;
    for (std::size_t i = 40; i < 360; ++i) {
        before += square(glm::distance(noisy.positions[i], whole.positions[i]));
        after += square(glm::distance(motion.positions[i], whole.positions[i]));
    }
    CHECK(after < 0.3f * before);
}

}  // namespace limn::marker_cleanup_test
