#include "ecs/components/path.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace limn {

namespace {

PathKnot knot(const Vec3& position) {
    PathKnot made;
    made.position = position;
    return made;
}

/// A circle of radius 10 about the origin in the x-z plane, by four segments (off by 2.7e-4).
PathShape circle() {
    constexpr float k = 10 * 0.5522847f;
    PathShape shape;
    shape.closed = true;
    shape.knots = {
        {{10, 0, 0}, {0, 0, k}, {0, 0, -k}, 0},
        {{0, 0, -10}, {k, 0, 0}, {-k, 0, 0}, 0},
        {{-10, 0, 0}, {0, 0, -k}, {0, 0, k}, 0},
        {{0, 0, 10}, {-k, 0, 0}, {k, 0, 0}, 0}};
    return shape;
}

}  // namespace

TEST_CASE(
    "path: n segments have n + 1 knots, closed ones n, and go exactly through them"
    * technique("anim.bezier-track")) {
    PathShape shape;
    for (int i = 0; i < 5; ++i) {
        const auto x = static_cast<float>(i);
        shape.knots.push_back(knot({3.0f * x, i % 2 == 0 ? 0.0f : 2.0f, -x * x}));
    }
    const PathData path = *make_path(shape);
    REQUIRE(path.segments.size() == 4);  // 13 points, 5 of them knots
    for (std::size_t i = 0; i < 5; ++i) {
        CAPTURE(i);
        CHECK(path_frame_at(path, path.begins[i]).position == shape.knots[i].position);
    }
    for (std::size_t i = 1; i < 4; ++i) {  // smooth: joined ends are as control points ask
        CHECK(find_join(path.segments[i - 1], path.segments[i]) >= BezierJoin::Direction);
    }
    shape.closed = true;
    CHECK(make_path(shape)->segments.size() == 5);
    shape.closed = false;
    shape.knots.resize(2);
    CHECK(make_path(shape)->segments.size() == 1);
}

TEST_CASE(
    "path: control points at thirds of a segment give straight lines at constant speed"
    * technique("anim.bezier-track")) {
    PathShape shape;
    shape.knots = {
        {{0, 0, 0}, {}, {1, 0, 0}, 0},
        {{3, 0, 0}, {-1, 0, 0}, {0, 0, 2}, 0},
        {{3, 0, 6}, {0, 0, -2}, {}, 0}};
    const PathData path = *make_path(shape);
    CHECK(path.length() == test::near(9));
    for (int i = 0; i <= 90; ++i) {
        const float s = 0.1f * static_cast<float>(i);
        const Vec3 expected = s < 3 ? Vec3(s, 0, 0) : Vec3(3, 0, s - 3);
        CHECK(glm::distance(path_frame_at(path, s).position, expected) < 1e-4f);
    }
}

TEST_CASE(
    "path: the first knot's incoming and the last one's outgoing point have no effect"
    * technique("anim.bezier-track")) {
    PathShape shape;
    shape.knots = {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 0}, {{3, 2, 0}, {-1, 0, 0}, {0, 1, 0}, 0}};
    const PathData path = *make_path(shape);
    shape.knots[0].before = {7, 7, 7};
    shape.knots[1].after = {-7, 7, 7};
    const PathData other = *make_path(shape);
    for (int i = 0; i <= 10; ++i) {
        const double s = 0.1 * i * static_cast<double>(path.length());
        CHECK(path_frame_at(path, s).position == path_frame_at(other, s).position);
    }
}

TEST_CASE(
    "path: equal distances are equal arc lengths, lap after lap" * technique("anim.arclength")) {
    const PathData path = *make_path(circle());
    const double length = path.length();
    CHECK(length == test::near(2 * kPi * 10).epsilon(1e-3));
    for (int i = 0; i < 200; ++i) {
        const double s = length * i / 100.0;  // twice round
        const Vec3 here = path_frame_at(path, s).position;
        const Vec3 there = path_frame_at(path, s + 0.01 * length).position;
        const float chord = 20 * std::sin(kPi / 100);
        CHECK(glm::distance(here, there) == test::near(chord).epsilon(2e-3));
        CHECK(glm::distance(here, path_frame_at(path, s - 3 * length).position) < 1e-4f);
    }
}

TEST_CASE("path: frames are upright, at right angles, and turn with the curve") {
    const PathData path = *make_path(circle());
    for (int i = 0; i < 40; ++i) {
        const double s = 1.57 * i;
        const PathFrame frame = path_frame_at(path, s);
        CHECK(glm::length(frame.ahead) == test::near(1));
        CHECK(std::abs(glm::dot(frame.ahead, frame.up)) < 1e-6f);
        CHECK(frame.up.y == test::near(1));
        CHECK(std::abs(glm::dot(frame.ahead, glm::normalize(frame.position))) < 0.01f);
        CHECK(path_curvature(path, s) == test::near(0.1).epsilon(0.03));  // to the left
    }
    PathShape mirrored = circle();
    std::swap(mirrored.knots[1], mirrored.knots[3]);
    for (PathKnot& each : mirrored.knots) {
        std::swap(each.before, each.after);
    }
    CHECK(path_curvature(*make_path(mirrored), 5) == test::near(-0.1).epsilon(0.02));
}

TEST_CASE("path: roll leans to the right, smoothly from knot to knot") {
    PathShape shape;
    shape.knots = {knot({0, 0, 0}), knot({0, 0, 10}), knot({0, 0, 20})};
    shape.knots[1].roll = 0.5f;
    const PathData path = *make_path(shape);
    CHECK(path_frame_at(path, 0).up == Vec3(0, 1, 0));
    const PathFrame halfway = path_frame_at(path, 10);
    const Vec3 right = {-1, 0, 0};  // looking along +z
    CHECK(glm::dot(halfway.up, right) == test::near(std::sin(0.5)));
    CHECK(halfway.up.y == test::near(std::cos(0.5)));
    float last = 0;
    for (int i = 0; i <= 100; ++i) {
        const float roll = path_frame_at(path, 0.1 * i).roll;
        CHECK(roll >= last);
        CHECK(roll - last < 0.01f);
        last = roll;
    }
}

TEST_CASE("path: a knot on its control point, or two at one position, still have a direction") {
    PathShape shape;
    shape.knots = {
        {{0, 0, 0}, {}, {1e-9f, 0, 0}, 0},
        {{0, 0, 5}, {0, 1e-9f, 0}, {}, 0},
        knot({0, 0, 5}),
        knot({0, 0, 9})};
    const PathData path = *make_path(shape);
    for (int i = -5; i <= 100; ++i) {
        const PathFrame frame = path_frame_at(path, 0.1 * i);
        CHECK(std::isfinite(frame.position.z));
        CHECK(glm::length(frame.ahead) == test::near(1));
        CHECK(std::isfinite(path_curvature(path, 0.1 * i)));
    }
    CHECK(path_frame_at(path, std::nan("")).position == Vec3(0));
    CHECK(path_frame_at(path, std::numeric_limits<double>::infinity()).position == Vec3(0));
}

TEST_CASE(
    "path: all joins of a smooth path have equal speed, a bent one has corners"
    * technique("anim.bezier-join")) {
    PathShape shape = circle();
    CHECK(path_joins(*make_path(shape)) == std::vector<BezierJoin>(4, BezierJoin::Speed));
    shape.knots[1].after *= 2.0f;
    shape.knots[2].before = {5, 0, 5};
    shape.closed = false;
    CHECK(
        path_joins(*make_path(shape))
        == std::vector<BezierJoin>{BezierJoin::Direction, BezierJoin::Position});
}

TEST_CASE(
    "path: a knot that slides between its control points or rotates them stays smooth"
    * technique("anim.bezier-edit")) {
    PathShape shape = circle();
    shape.knots[0].slide = 0.25f;
    shape.knots[1].turn = glm::angleAxis(0.5f, Vec3(0, 1, 0));
    const PathData path = *make_path(shape);
    // Between (10, 0, k) and (10, 0, -k), a quarter of the distance from the first.
    CHECK(path.segments[0][0].x == test::near(10));
    CHECK(path.segments[0][0].z == test::near(0.5 * 10 * 0.5522847));
    const Vec3 out = path.segments[1][1] - path.segments[1][0];
    CHECK(glm::length(out) == test::near(10 * 0.5522847));
    CHECK(out.x == test::near(-10 * 0.5522847 * std::cos(0.5)));
    CHECK(out.z == test::near(10 * 0.5522847 * std::sin(0.5)));
    CHECK(
        path_joins(path)
        == std::vector<BezierJoin>{
            BezierJoin::Speed, BezierJoin::Speed, BezierJoin::Speed, BezierJoin::Direction});
}

TEST_CASE(
    "path: the corners of a parabolic blend give the curve of the blend"
    * technique("anim.boehm-quadrangle, anim.parabolic-blend")) {
    PathShape shape;
    shape.curve = PathCurve::Parabolic;
    shape.knots = {{{0, 0, 0}, {0, 0, 0}, {1, 2, 0}, 0}, {{6, 0, 1}, {-2, 3, 0}, {0, 0, 0}, 0}};
    const PathData path = *make_path(shape);
    const std::array<Vec3, 4> corners = {
        Vec3(0, 0, 0), Vec3(1, 2, 0), Vec3(4, 3, 1), Vec3(6, 0, 1)};
    for (const float u : {0.1f, 0.35f, 0.5f, 0.8f}) {
        const Vec3 expected = parabolic_blend(corners, u);
        CHECK(glm::length(bezier_point(path.segments[0], u) - expected) < 1e-5f);
    }
}

TEST_CASE("path: an invalid path is rejected with its location") {
    PathShape shape;
    CHECK(make_path(shape).error().message == "found 0 knots, expected at least 2");
    shape.knots = {knot({1, 2, 3}), knot({1, 2, 3})};
    CHECK(
        make_path(shape).error().message
        == "all knots coincide, expected a path of nonzero length");
    shape.knots[1].position.y = std::nanf("");
    CHECK(make_path(shape).error().message == "knots[1]: found a number that is not finite");
}

}  // namespace limn
