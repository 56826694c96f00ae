#include "content/bake/marker_motion.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace limn::marker_motion_test {

using test::near;

namespace {

const Vec3 kMissing(std::numeric_limits<float>::quiet_NaN());

/// The first four are on the head, the others on the face.
const std::vector<Vec3> kRest = {{-0.08f, 0.1f, 0},       {0.08f, 0.1f, 0},  {0, 0.18f, 0.05f},
                                 {0, 0.1f, 0.09f},        {0, -0.05f, 0.1f}, {0.03f, -0.05f, 0.09f},
                                 {-0.03f, -0.05f, 0.09f}, {0, -0.08f, 0.09f}};
const std::vector<std::uint32_t> kHead = {0, 1, 2, 3};

Affine head_at(std::size_t frame) {
    Random random(frame, 2, 3, 4);
    const Vec3 axis = random.direction();
    return affine_from(
        0.5f * random.direction(), glm::angleAxis(2.5f * random.uniform(), axis), Vec3(1));
}

/// Motion in which only the face's markers leave their places on the head.
MarkerMotion make_motion(std::size_t frames, float opening, bool head_moves) {
    MarkerMotion motion;
    motion.rate = 10;
    motion.names.assign(kRest.size(), "marker");
    for (std::size_t f = 0; f < frames; ++f) {
        for (std::size_t m = 0; m < kRest.size(); ++m) {
            const Vec3 p =
                kRest[m] + (m < 4 ? Vec3(0) : Vec3(0, -opening * static_cast<float>(f), 0));
            motion.positions.push_back(head_moves ? transform_point(head_at(f), p) : p);
        }
    }
    return motion;
}

float determinant(const Affine& a) {
    return glm::determinant(Mat3(Vec3(a.row[0]), Vec3(a.row[1]), Vec3(a.row[2])));
}

}  // namespace

TEST_CASE(
    "head motion: markers that move with the head are at rest once it is stabilized"
    * technique("face.head-stabilise")) {
    MarkerMotion motion = make_motion(20, 0, true);
    const std::vector<Affine> heads = *stabilize_head(motion, kRest, kHead);
    REQUIRE(heads.size() == 20);
    for (std::size_t f = 0; f < 20; ++f) {
        for (std::size_t m = 0; m < kRest.size(); ++m) {
            CHECK(glm::distance(motion.positions[f * kRest.size() + m], kRest[m]) < 1e-6f);
        }
        for (int i = 0; i < 3; ++i) {
            CHECK(glm::length(heads[f].row[i] - head_at(f).row[i]) < 2e-6f);
        }
    }
}

TEST_CASE("head motion: motion of the face itself is kept" * technique("face.head-stabilise")) {
    MarkerMotion motion = make_motion(20, 0.001f, true);
    REQUIRE(stabilize_head(motion, kRest, kHead).ok());
    const MarkerMotion want = make_motion(20, 0.001f, false);
    for (std::size_t i = 0; i < want.positions.size(); ++i) {
        CHECK(glm::distance(motion.positions[i], want.positions[i]) < 1e-6f);
    }
}

TEST_CASE(
    "head motion: a fit is a rotation, of mirrored points too, and the best one of noisy"
    * technique("face.head-stabilise")) {
    std::vector<Vec3> mirrored;
    std::vector<Vec3> noisy;
    Random random(7, 7, 7, 7);
    for (const Vec3& p : kRest) {
        mirrored.emplace_back(-p.x, p.y, p.z);
        noisy.push_back(transform_point(head_at(3), p) + 0.003f * random.direction());
    }
    CHECK(determinant(*fit_rigid(kRest, mirrored)) == near(1));
    const Affine best = *fit_rigid(kRest, noisy);
    CHECK(determinant(best) == near(1));
    const auto error = [&](const Affine& fit) {
        double sum = 0;
        for (std::size_t i = 0; i < kRest.size(); ++i) {
            const Vec3 off = transform_point(fit, kRest[i]) - noisy[i];
            sum += static_cast<double>(glm::dot(off, off));
        }
        return sum;
    };
    for (int i = 0; i < 60; ++i) {
        const Affine nudge = affine_from(
            1e-3f * random.direction(), glm::angleAxis(3e-3f, random.direction()), Vec3(1));
        CHECK(error(nudge * best) > error(best));
    }
}

TEST_CASE(
    "head motion: too few markers, those in a line and missing ones are named"
    * technique("face.head-stabilise")) {
    MarkerMotion motion = make_motion(3, 0, true);
    const auto error = [&](const std::vector<std::uint32_t>& head) {
        const std::vector<Vec3> before = motion.positions;
        const auto result = stabilize_head(motion, kRest, head);
        CHECK((result.ok() || motion.positions[0] == before[0]));
        return result ? std::string("none") : result.error().message;
    };
    CHECK(error({0, 1}) == "found 2 markers on the head, expected at least 3");
    CHECK(error({0, 0, 1}) == "the markers on the head lie in a line");
    for (std::size_t f = 0; f < 3; ++f) {
        motion.positions[f * kRest.size() + 1] = kMissing;
        motion.positions[f * kRest.size() + 3] = kMissing;
    }
    CHECK(error(kHead) == "found no frame with three markers on the head that are visible");
    CHECK(error({0, 2, 4}) == "none");
}

TEST_CASE(
    "head motion: hidden markers on the head are done without, and gaps are crossed evenly"
    * technique("face.head-stabilise")) {
    MarkerMotion motion = make_motion(20, 0, true);
    for (std::size_t f = 1; f < 19; ++f) {
        motion.positions[f * kRest.size() + f % 4] = kMissing;
    }
    const std::vector<Affine> heads = *stabilize_head(motion, kRest, kHead);
    for (std::size_t f = 0; f < 20; ++f) {
        for (int i = 0; i < 3; ++i) {
            CHECK(glm::length(heads[f].row[i] - head_at(f).row[i]) < 4e-6f);
        }
        CHECK(glm::distance(motion.positions[f * kRest.size() + 5], kRest[5]) < 2e-6f);
        CHECK(is_finite(motion.positions[f * kRest.size() + f % 4]) == (f == 0 || f == 19));
    }
    // A head that turns about z by 0.1 a frame, unseen in frames 3 to 6 and at the end.
    MarkerMotion turning = make_motion(10, 0, false);
    for (std::size_t i = 0; i < turning.positions.size(); ++i) {
        const std::size_t f = i / kRest.size();
        const Quat turn = glm::angleAxis(0.1f * static_cast<float>(f), Vec3(0, 0, 1));
        const bool is_hidden = i % kRest.size() < 2 && ((f > 2 && f < 7) || f == 9);
        turning.positions[i] = is_hidden ? kMissing : turn * turning.positions[i];
    }
    const std::vector<Affine> even = *stabilize_head(turning, kRest, kHead);
    for (std::size_t f = 0; f < 10; ++f) {
        const float angle = std::atan2(even[f].row[1].x, even[f].row[0].x);
        // In the gap along the chord from 0.2 to 0.7.
        const float t = (static_cast<float>(f) - 2.0f) / 5.0f;
        const float want = f > 2 && f < 7 ? 0.45f + std::atan((2.0f * t - 1.0f) * std::tan(0.25f))
                                          : 0.1f * static_cast<float>(std::min<std::size_t>(f, 8));
        CHECK(std::abs(angle - want) < 1e-5f);
    }
}

TEST_CASE(
    "markers: they are linear between frames, and constant beyond the ends"
    * technique("face.mocap-drive")) {
    const MarkerMotion motion = make_motion(5, 0.01f, false);
    CHECK(sample_markers(motion, 0.1f)[4].y == near(-0.06));
    CHECK(sample_markers(motion, 0.125f)[4].y == near(-0.0625));
    CHECK(sample_markers(motion, 0.19f)[4].y == near(-0.069));
    CHECK(sample_markers(motion, -3)[4].y == near(-0.05));
    CHECK(sample_markers(motion, 99)[4].y == near(-0.09));
}

TEST_CASE(
    "markers: a hidden one moves with its neighbors, between its last and its next position"
    * technique("face.mocap-drive")) {
    // It moves as they do: found exactly.
    MarkerMotion motion = make_motion(12, 0.002f, false);
    const MarkerMotion want = motion;
    for (std::size_t f = 4; f < 8; ++f) {
        for (std::size_t m : {std::size_t{4}, std::size_t{5}}) {
            motion.positions[f * kRest.size() + m] = kMissing;
        }
    }
    std::vector<Vec3> face(kRest.begin() + 4, kRest.end());
    MarkerMotion only_face = motion;
    only_face.names.resize(4);
    only_face.positions.clear();
    for (std::size_t f = 0; f < 12; ++f) {
        for (std::size_t m = 4; m < 8; ++m) {
            only_face.positions.push_back(motion.positions[f * kRest.size() + m]);
        }
    }
    fill_gaps(only_face, face);
    for (std::size_t f = 0; f < 12; ++f) {
        for (std::size_t m = 4; m < 8; ++m) {
            CHECK(
                glm::distance(
                    only_face.positions[f * 4 + m - 4], want.positions[f * kRest.size() + m])
                < 1e-6f);
        }
    }
    // It differs from them: no jump at either end, and finite throughout.
    MarkerMotion other = make_motion(12, 0.002f, false);
    for (std::size_t f = 0; f < 12; ++f) {
        other.positions[f * kRest.size() + 7].x += 0.001f * static_cast<float>(f);
    }
    const MarkerMotion all = other;
    for (std::size_t f = 3; f < 9; ++f) {
        other.positions[f * kRest.size() + 7] = kMissing;
    }
    fill_gaps(other, kRest);
    for (std::size_t f = 0; f < 12; ++f) {
        CHECK(
            glm::distance(
                other.positions[f * kRest.size() + 7], all.positions[f * kRest.size() + 7])
            < 1e-6f);
    }
}

TEST_CASE("markers: hidden at the start, at the end or always, they are still somewhere near") {
    MarkerMotion motion = make_motion(6, 0.002f, false);
    for (std::size_t f = 0; f < 6; ++f) {
        motion.positions[f * kRest.size() + 7] = kMissing;
        if (f < 2 || f > 3) {
            motion.positions[f * kRest.size() + 6] = kMissing;
        }
    }
    fill_gaps(motion, kRest);
    for (std::size_t i = 0; i < motion.positions.size(); ++i) {
        CHECK(is_finite(motion.positions[i]));
        CHECK(glm::distance(motion.positions[i], kRest[i % kRest.size()]) < 0.02f);
    }
    MarkerMotion nothing = make_motion(2, 0, false);
    nothing.positions.assign(nothing.positions.size(), kMissing);
    fill_gaps(nothing, kRest);
    CHECK(nothing.positions[5] == kRest[5]);
}

}  // namespace limn::marker_motion_test
