#include "ecs/base/bezier.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace limn;

namespace {

const Bezier<Vec2> kArch = {Vec2(0, 0), Vec2(0, 1), Vec2(1, 1), Vec2(1, 0)};
const Bezier<Vec2> kBend = {Vec2(0, 0), Vec2(0, 4), Vec2(1, 4), Vec2(8, 0)};

Vec3 any_vector(Random& random) {
    return random.uniform(0.2f, 3.0f) * random.direction();
}

/// The longest over the shortest of ten chords between the points at `parameter(k / 10)`.
template <typename Parameter>
float unevenness(const Bezier<Vec2>& p, Parameter&& parameter) {
    std::vector<float> chords;
    for (int k = 0; k < 10; ++k) {
        const Vec2 from = bezier_point(p, parameter(static_cast<float>(k) / 10));
        const Vec2 to = bezier_point(p, parameter(static_cast<float>(k + 1) / 10));
        chords.push_back(glm::length(to - from));
    }
    const auto [low, high] = std::minmax_element(chords.begin(), chords.end());
    return *high / *low;
}

float chords_of(const Bezier<Vec2>& p, int steps) {
    float length = 0;
    for (int k = 0; k < steps; ++k) {
        const float n = static_cast<float>(steps);
        const Vec2 from = bezier_point(p, static_cast<float>(k) / n);
        length += glm::length(bezier_point(p, static_cast<float>(k + 1) / n) - from);
    }
    return length;
}

/// Two curves of which the second begins as the first ends, `k` times as slow.
struct Joined {
    Bezier<Vec3> first = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 2, 0), Vec3(2, 2, 1)};
    Bezier<Vec3> second;
    explicit Joined(float k) {
        second[0] = first[3];
        second[1] = first[3] + (first[3] - first[2]) / k;
        second[2] = Vec3(5, 2, 1);
        second[3] = Vec3(6, 0, 0);
    }
};

bool is_smooth(const BezierKnot& knot) {
    const Bezier<Vec3> first = {Vec3(9, 9, 9), Vec3(8, 7, 6), knot.before, knot.key};
    const Bezier<Vec3> second = {knot.key, knot.after, Vec3(1, 1, 1), Vec3(2, 2, 2)};
    return find_join(first, second) >= BezierJoin::Direction;
}

}  // namespace

TEST_CASE(
    "bezier: chords underestimate the length, and more chords less so"
    * technique("anim.arclength")) {
    // The arch is 2 long; until u it is 3 u - 3 u^2 + 2 u^3.
    const ChordTable table = measure_chords(kArch);
    CHECK(table.total() == test::near(1.999921).epsilon(1e-6));
    CHECK(table.length[25] == test::near(0.59375).epsilon(1e-4));
    CHECK(table.length[50] == test::near(1).epsilon(1e-4));
    CHECK(chords_of(kArch, 10) == test::near(1.992141).epsilon(1e-6));
    CHECK(table.total() == test::near(chords_of(kArch, 100)).epsilon(1e-6));
    CHECK(2 - chords_of(kArch, 10) == test::near(100 * (2 - chords_of(kArch, 100))).epsilon(0.02));
    CHECK(std::is_sorted(table.length.begin(), table.length.end()));
    CHECK(table.total() < 2);
    CHECK(measure_chords(kBend).total() == test::near(11.0366).epsilon(1e-5));
}

TEST_CASE(
    "bezier: equal fractions of the length are equally long, equal steps of u are not"
    * technique("anim.arclength")) {
    const ChordTable table = measure_chords(kBend);
    CHECK(unevenness(kBend, [](float u) { return u; }) == test::near(4.1301).epsilon(1e-4));
    const float even =
        unevenness(kBend, [&](float fraction) { return table.parameter_at(fraction); });
    CHECK(even == test::near(1.042).epsilon(1e-3));
}

TEST_CASE(
    "bezier: on a straight, even curve the fraction is u; also on a single point"
    * technique("anim.arclength")) {
    const ChordTable line = measure_chords(Bezier<float>{2, 3, 4, 5});
    const ChordTable point = measure_chords(Bezier<float>{7, 7, 7, 7});
    CHECK(line.total() == test::near(3));
    CHECK(point.total() == 0);
    for (const float fraction : {-1.0f, 0.0f, 0.005f, 0.37f, 0.995f, 1.0f, 2.0f}) {
        const float expected = std::clamp(fraction, 0.0f, 1.0f);
        CHECK(line.parameter_at(fraction) == test::near(expected).epsilon(1e-5));
        CHECK(point.parameter_at(fraction) == expected);
    }
    // A curve with a stretch of length 0.
    const ChordTable late = measure_chords(Bezier<float>{0, 0, 0, 1});
    CHECK(late.parameter_at(0) >= 0);
    CHECK(late.parameter_at(1) == 1);
    const ChordTable early = measure_chords(Bezier<float>{1e4f, 1e4f + 1, 1e4f + 1, 1e4f + 1});
    CHECK(early.length[99] == early.total());
    CHECK(early.parameter_at(1) == test::near(1).epsilon(0.2));
}

TEST_CASE(
    "bezier: joins are classified by position, direction and speed"
    * technique("anim.bezier-join")) {
    for (const float k : {1.0f, 2.0f}) {
        const Joined joined(k);
        const Vec3 in = bezier_derivative(joined.first, 1);
        const Vec3 out = bezier_derivative(joined.second, 0);
        CHECK(glm::length(glm::cross(in, out)) < 1e-5f);
        CHECK(glm::length(in) / glm::length(out) == test::near(k));
        CHECK(
            find_join(joined.first, joined.second)
            == (k == 1 ? BezierJoin::Speed : BezierJoin::Direction));
    }
    CHECK(find_join(Joined(-1).first, Joined(-1).second) == BezierJoin::Position);
    Joined bent(1);
    bent.second[1] += Vec3(0, 0.01f, 0);
    CHECK(find_join(bent.first, bent.second) == BezierJoin::Position);
    Joined stopped(1);
    stopped.first[2] = stopped.first[3];  // no direction to go on in
    CHECK(find_join(stopped.first, stopped.second) == BezierJoin::Position);
    Joined torn(1);
    torn.second[0] += Vec3(0.1f, 0, 0);
    CHECK(find_join(torn.first, torn.second) == BezierJoin::None);
}

TEST_CASE(
    "bezier: a key that slides, rotates or moves with its control points stays smooth"
    * technique("anim.bezier-edit")) {
    const BezierKnot knot = {Vec3(1, 0, 0), Vec3(2, 1, 0.5f), Vec3(4, 3, 1.5f)};
    REQUIRE(is_smooth(knot));
    for (const float t : {-1.0f, 0.0f, 0.3f, 0.9f, 1.0f}) {
        const BezierKnot slid = slide_knot(knot, t);
        CHECK(is_smooth(slid));
        CHECK(slid.before == knot.before);
        CHECK(slid.after == knot.after);
        const float fraction =
            glm::length(slid.key - slid.before) / glm::length(slid.after - slid.before);
        CHECK(fraction == test::near(std::clamp(t, 0.01f, 0.99f)).epsilon(1e-4));
    }
    const BezierKnot turned = rotate_knot(knot, rotation_about({1, -1, 2}, 0.7f));
    CHECK(is_smooth(turned));
    CHECK(turned.key == knot.key);
    CHECK(glm::length(turned.before - knot.before) > 0.1f);
    CHECK(
        glm::length(turned.before - turned.key) == test::near(glm::length(knot.before - knot.key)));
    CHECK(glm::length(turned.after - turned.key) == test::near(glm::length(knot.after - knot.key)));
    const BezierKnot moved = move_knot(knot, {3, -1, 2});
    CHECK(is_smooth(moved));
    CHECK(moved.before - moved.key == knot.before - knot.key);
    CHECK(moved.after - moved.key == knot.after - knot.key);
}

TEST_CASE(
    "bezier: a parabolic blend runs from corner to corner of its base"
    * technique("anim.parabolic-blend")) {
    const std::array<Vec2, 4> square = {Vec2(0, 0), Vec2(0, 1), Vec2(1, 1), Vec2(1, 0)};
    CHECK(parabolic_blend(square, 0.0f) == square[0]);
    CHECK(parabolic_blend(square, 1.0f) == square[3]);
    CHECK(parabolic_blend(square, 0.5f) == Vec2(0.5f, 0.5f));
    CHECK(parabolic_blend(square, 0.25f) == Vec2(0.25f, 0.375f));
    // Over a parallelogram it is a parabola: its second difference is constant.
    const std::array<Vec2, 4> skew = {Vec2(0, 0), Vec2(0.5f, 2), Vec2(3.5f, 3), Vec2(3, 1)};
    const auto second_difference = [](const auto& corners, float u) {
        return parabolic_blend(corners, u - 0.1f) - 2.0f * parabolic_blend(corners, u)
               + parabolic_blend(corners, u + 0.1f);
    };
    const std::array<Vec2, 4> general = {Vec2(0, 0), Vec2(0, 2), Vec2(5, 3), Vec2(3, 1)};
    const Vec2 change = second_difference(skew, 0.8f) - second_difference(skew, 0.2f);
    CHECK(glm::length(change) < 1e-5f);
    CHECK(glm::length(second_difference(general, 0.8f) - second_difference(general, 0.2f)) > 1e-2f);
}

TEST_CASE(
    "bezier: every cubic is the parabolic blend of some corners, and is restored from them"
    * technique("anim.boehm-quadrangle")) {
    Random random(3, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const Bezier<Vec3> p = {
            any_vector(random), any_vector(random), any_vector(random), any_vector(random)};
        const std::array<Vec3, 4> corners = quadrangle_of(p);
        const Bezier<Vec3> back = bezier_of(corners);
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(glm::length(back[k] - p[k]) < 1e-5f);
        }
        for (int k = 0; k <= 10; ++k) {
            const float u = static_cast<float>(k) / 10;
            CHECK(glm::length(parabolic_blend(corners, u) - bezier_point(p, u)) < 3e-6f);
        }
    }
    const auto corners = quadrangle_of(Bezier<float>{0, 1, 3, 2});
    CHECK(corners[1] == 0.5f);
    CHECK(corners[2] == 4.5f);
}
