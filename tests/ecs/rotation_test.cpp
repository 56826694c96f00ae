#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cmath>
#include <vector>

using namespace limn;

namespace {

const Vec3 kX(1, 0, 0);
const Vec3 kY(0, 1, 0);
const Vec3 kZ(0, 0, 1);
const Quat kNone(1, 0, 0, 0);

Quat about_z(float angle) {
    return rotation_about(kZ, radians(angle));
}

/// Unit quaternions all over the sphere.
struct Quats {
    Random random{77, 0, 0, 0};
    Quat next() {
        const Vec4 q(random.normal(), random.normal(), random.normal(), random.normal());
        return normalize_or_identity(Quat(q.w, q.x, q.y, q.z));
    }
    Vec3 vector() { return random.uniform(0.1f, 2.0f) * random.direction(); }
};

/// How far two quaternions are apart as four numbers.
float apart(const Quat& a, const Quat& b) {
    return glm::length(a - b);
}
/// How far two rotations are apart, whatever the signs of their quaternions.
float turned(const Quat& a, const Quat& b) {
    return std::min(apart(a, b), apart(a, -b));
}
float apart(const Vec3& a, const Vec3& b) {
    return glm::length(a - b);
}
float angle_of(const Quat& q) {
    return degrees(axis_angle(q).angle);
}

}  // namespace

TEST_CASE(
    "rotation: exp is the inverse of log, also near the identity and near a full turn"
    * technique("anim.quat-algebra")) {
    Quats quats;
    for (int i = 0; i < 1000; ++i) {
        const Quat q = quats.next();
        if (q.w > -1 + 1e-4f) {
            CHECK(apart(exp_rotation(log_rotation(q)), q) < 1e-6f);
        }
    }
    CHECK(log_rotation(kNone) == Vec3(0));
    CHECK(exp_rotation(Vec3(0)) == kNone);
    CHECK(apart(log_rotation(-kNone), Vec3(kPi, 0, 0)) < 1e-6f);
    CHECK(apart(exp_rotation(log_rotation(-kNone)), -kNone) < 1e-6f);
    for (const float tiny : {1e-20f, 1e-10f, 1e-6f, 9e-5f, 1.1e-4f, 1e-3f}) {
        const Vec3 half = tiny * glm::normalize(Vec3(1, -2, 3));
        CHECK(apart(log_rotation(exp_rotation(half)), half) <= 1e-6f * tiny);
    }
}

TEST_CASE(
    "rotation: normalizing zero, infinite and NaN quaternions gives the identity"
    * technique("anim.quat-algebra")) {
    CHECK(normalize_or_identity(Quat(0, 0, 0, 0)) == kNone);
    CHECK(normalize_or_identity(Quat(NAN, 1, 0, 0)) == kNone);
    CHECK(normalize_or_identity(Quat(INFINITY, 1, 0, 0)) == kNone);
    CHECK(apart(normalize_or_identity(Quat(0, 0, 3, 4)), Quat(0, 0, 0.6f, 0.8f)) < 1e-7f);
}

TEST_CASE(
    "rotation: vectors turn about the axis by the angle, right-handed"
    * technique("anim.quat-rotate")) {
    CHECK(apart(about_z(90) * kX, kY) < 1e-6f);
    const Quat odd = rotation_about({1, 2, 3}, radians(50));
    CHECK(apart(odd * Vec3(0.3f, -0.7f, 2), Vec3(1.566738f, -0.425110f, 1.394494f)) < 2e-6f);
    Quats quats;
    for (int i = 0; i < 1000; ++i) {
        // Rodrigues' formula, in double precision.
        const glm::dvec3 axis = quats.vector();
        const float angle = quats.random.uniform(-10.0f, 10.0f);
        const glm::dvec3 r = quats.vector();
        const glm::dvec3 n = glm::normalize(axis);
        const double c = std::cos(static_cast<double>(angle));
        const double s = std::sin(static_cast<double>(angle));
        const glm::dvec3 want = c * r + (1 - c) * glm::dot(n, r) * n + s * glm::cross(n, r);
        const Quat q = rotation_about(Vec3(axis), angle);
        CHECK(glm::length(q) == test::near(1).epsilon(1e-6));
        CHECK(apart(q * Vec3(r), Vec3(want)) < 4e-6f);
        const auto [back_axis, back_angle] = axis_angle(q);
        CHECK(apart(rotation_about(back_axis, back_angle), q) < 2e-6f);
    }
}

TEST_CASE(
    "rotation: axis and angle are restored, from 0 to a full turn"
    * technique("anim.quat-axis-angle")) {
    CHECK(apart(about_z(90), Quat(0.70710678f, 0, 0, 0.70710678f)) < 1e-7f);
    const Vec3 axis = glm::normalize(Vec3(2, -1, 0.5f));
    for (int degree = 1; degree < 360; ++degree) {
        const AxisAngle back =
            axis_angle(rotation_about(3.0f * axis, radians(static_cast<float>(degree))));
        CHECK(degrees(back.angle) == test::near(degree).epsilon(1e-5));
        CHECK(apart(back.axis, axis) < 2e-5f);
    }
    CHECK(axis_angle(kNone).angle == 0);
    CHECK(axis_angle(kNone).axis == kX);
    CHECK(axis_angle(Quat(1.0000002f, 0, 0, 0)).angle == 0);  // its arc cosine is NaN
    CHECK(angle_of(-kNone) == test::near(360));
    CHECK(rotation_about(Vec3(0), 1) == kNone);
}

TEST_CASE(
    "rotation: an affine map scales along the mesh's axes, rotates, then translates; -q is the same"
    * technique("anim.quat-to-matrix")) {
    Quats quats;
    for (int i = 0; i < 1000; ++i) {
        const Quat q = quats.next();
        const Vec3 position = quats.vector();
        const Vec3 scale = quats.vector();
        const Affine a = affine_from(position, q, scale);
        const Vec3 p = quats.vector();
        CHECK(apart(transform_point(a, p), q * (scale * p) + position) < 1e-5f);
        CHECK(apart(transform_vector(a, p), q * (scale * p)) < 1e-5f);
        CHECK(apart(Vec3(to_mat4(a) * Vec4(p, 1)), transform_point(a, p)) < 1e-5f);
        const Affine opposite = affine_from(position, -q, scale);
        for (int row = 0; row < 3; ++row) {
            CHECK(opposite.row[row] == a.row[row]);
            CHECK(to_affine(to_mat4(a)).row[row] == a.row[row]);
        }
    }
    // Columns are where the axes go: x to y, y to z, z to x.
    const Affine third = affine_from({7, 8, 9}, Quat(0.5f, 0.5f, 0.5f, 0.5f), {1, 2, 3});
    CHECK(third.row[0] == Vec4(0, 0, 3, 7));
    CHECK(third.row[1] == Vec4(1, 0, 0, 8));
    CHECK(third.row[2] == Vec4(0, 2, 0, 9));
}

TEST_CASE(
    "rotation: a matrix gives its quaternion back, half turns included"
    * technique("anim.quat-from-matrix")) {
    Quats quats;
    for (int i = 0; i < 10'000; ++i) {
        const Quat q = quats.next();
        const Mat3 m = glm::mat3_cast(q);
        const auto back = extract_rotation(m);
        REQUIRE(back.has_value());
        CHECK(turned(*back, q) < 2e-6f);
    }
    for (const Vec3& axis : {kX, kY, kZ, Vec3(1, 1, 0), Vec3(-1, 0, 1)}) {
        const Quat half = rotation_about(axis, kPi);
        CHECK(turned(extract_rotation(glm::mat3_cast(half)).value(), half) < 1e-6f);
    }
    CHECK(extract_rotation(Mat3(1)) == kNone);
    CHECK(apart(*extract_rotation(glm::mat3_cast(about_z(90))), about_z(90)) < 1e-6f);
}

TEST_CASE(
    "rotation: scale and shear are removed from a matrix, mirrored and flat ones are rejected"
    * technique("anim.quat-from-matrix")) {
    const Quat q = rotation_about({1, 2, 3}, 1.1f);
    Mat3 m = glm::mat3_cast(q);
    CHECK(apart(*extract_rotation(Mat3(2.0f * m[0], 5e3f * m[1], 1e-3f * m[2])), q) < 1e-6f);
    CHECK(apart(*extract_rotation(Mat3(m[0], m[1] + 0.4f * m[0], m[2] - 0.2f * m[1])), q) < 1e-6f);
    CHECK_FALSE(extract_rotation(Mat3(-m[0], m[1], m[2])).has_value());
    CHECK_FALSE(extract_rotation(Mat3(m[0], m[1], Vec3(0))).has_value());
    CHECK_FALSE(extract_rotation(Mat3(m[0], 2.0f * m[0], m[2])).has_value());
    CHECK_FALSE(extract_rotation(Mat3(0)).has_value());
    m[1][1] = NAN;
    CHECK_FALSE(extract_rotation(m).has_value());
}

TEST_CASE("rotation: slerp follows the great circle at constant speed" * technique("anim.slerp")) {
    CHECK(apart(slerp(kNone, about_z(90), 1.0f / 3), Quat(0.965926f, 0, 0, 0.258819f)) < 1e-6f);
    CHECK(apart(slerp(kNone, about_z(90), 0.25f), Quat(0.980785f, 0, 0, 0.195090f)) < 1e-6f);
    Quats quats;
    for (int i = 0; i < 300; ++i) {
        const Quat a = quats.next();
        const Quat b = to_same_hemisphere(a, quats.next());
        const Quat p = quats.next();
        const float omega = std::acos(std::min(glm::dot(a, b), 1.0f));
        for (const float u : {0.0f, 0.1f, 0.5f, 0.8f, 1.0f}) {
            const Quat q = slerp(a, b, u);
            CHECK(glm::length(q) == test::near(1).epsilon(1e-6));
            CHECK(
                std::atan2(apart(a, q) / 2, glm::length(a + q) / 2) * 2
                == test::near(u * omega).epsilon(1e-4).scale(1));
            CHECK(turned(q, slerp(b, a, 1 - u)) < 2e-6f);
            CHECK(turned(q, slerp(a, -b, u)) < 1e-6f);
            CHECK(apart(slerp(p * a, p * b, u), p * q) < 2e-6f);
        }
    }
}

TEST_CASE(
    "rotation: slerp does not jump where it becomes a straight line, nor divide by zero"
    * technique("anim.slerp")) {
    for (const float u : {0.25f, 0.5f, 0.9f}) {
        for (const float share : {0.999f, 1.001f, 10.0f, 100.0f}) {
            const float omega = share * std::sqrt(2e-6f);
            const Quat b(std::cos(omega), std::sin(omega) * kY);
            const Quat exact(std::cos(u * omega), std::sin(u * omega) * kY);
            CHECK(apart(slerp(kNone, b, u), exact) < 1e-6f);
        }
        CHECK(turned(slerp(kNone, -kNone, u), kNone) < 1e-7f);
        const Quat stays = slerp_along(kNone, -kNone, u);
        CHECK(glm::length(stays) == test::near(1));
        // Half a turn may go in either direction, but at even speed.
        const AxisAngle half =
            axis_angle(to_same_hemisphere(kNone, slerp(kNone, rotation_about(kY, kPi), u)));
        CHECK(half.angle == test::near(u * kPi).epsilon(1e-5));
        CHECK(std::abs(half.axis.y) == test::near(1));
    }
}

TEST_CASE(
    "rotation: nlerp is slow at the ends and fast in the center" * technique("anim.quat-lerp")) {
    for (const float u : {0.0f, 0.5f, 1.0f}) {
        CHECK(apart(nlerp(kNone, about_z(90), u), slerp(kNone, about_z(90), u)) < 1e-6f);
    }
    CHECK(angle_of(nlerp(kNone, about_z(90), 0.25f)) == test::near(21.598161).epsilon(1e-5));
    CHECK(angle_of(nlerp(kNone, about_z(170), 0.25f)) == test::near(35.768757).epsilon(1e-5));
    const auto speed = [](float total, float u) {
        constexpr float kStep = 1e-2f;
        return (angle_of(nlerp(kNone, about_z(total), u + kStep))
                - angle_of(nlerp(kNone, about_z(total), u)))
               / kStep;
    };
    CHECK(speed(90, 0.495f) / speed(90, 0.0f) == test::near(1.171573).epsilon(0.02));
    CHECK(speed(179.9f, 0.495f) / speed(179.9f, 0.0f) == test::near(2).epsilon(0.03));
    CHECK(glm::length(nlerp(kNone, -kNone, 0.5f)) == test::near(1));
}

TEST_CASE(
    "rotation: aligned keys are near each other and stay the rotations they were"
    * technique("anim.shortest-arc")) {
    Quats quats;
    std::vector<Quat> keys;
    for (int i = 0; i < 200; ++i) {
        keys.push_back(quats.next());
    }
    const std::vector<Quat> before = keys;
    align_rotations(keys);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        CHECK(turned(keys[i], before[i]) == 0);
        if (i > 0) {
            const float dot = glm::dot(keys[i - 1], keys[i]);
            CHECK(dot >= 0);
            CHECK(square(apart(keys[i - 1], keys[i])) == test::near(2 - 2 * dot).epsilon(1e-5));
        }
    }
    std::vector<Quat> again = keys;
    align_rotations(again);
    CHECK(again == keys);
    std::array<Quat, 2> nearly_round = {kNone, about_z(350)};
    align_rotations(nearly_round);
    const Quat middle = slerp_along(nearly_round[0], nearly_round[1], 0.5f);
    CHECK(turned(middle, about_z(-5)) < 1e-6f);
}

TEST_CASE(
    "rotation: squad passes through its keys with the tangent of their neighbors"
    * technique("anim.squad")) {
    const std::array<float, 4> angles = {0, 10, 40, 90};
    std::array<Quat, 4> q;
    for (std::size_t i = 0; i < 4; ++i) {
        q[i] = about_z(angles[i]);
    }
    const Quat a1 = squad_point(q[0], q[1], q[2]);
    const Quat a2 = squad_point(q[1], q[2], q[3]);
    CHECK(angle_of(a1) == test::near(5).epsilon(1e-4));
    CHECK(angle_of(a2) == test::near(35).epsilon(1e-4));
    const auto between = [&](float u) { return squad(q[1], a1, a2, q[2], u); };
    CHECK(angle_of(between(0)) == test::near(10).epsilon(1e-5));
    CHECK(angle_of(between(0.25f)) == test::near(15.625).epsilon(1e-4));
    CHECK(angle_of(between(0.5f)) == test::near(22.5).epsilon(1e-4));
    CHECK(angle_of(between(0.75f)) == test::near(30.625).epsilon(1e-4));
    CHECK(angle_of(between(1)) == test::near(40).epsilon(1e-5));
    // From both sides of the key at 40 degrees: (90 - 10) / 2 an interval.
    constexpr float kStep = 1e-2f;
    const float left = (40 - angle_of(between(1 - kStep))) / kStep;
    const float right = (angle_of(squad(q[2], a2, q[3], q[3], kStep)) - 40) / kStep;
    CHECK(left == test::near(40).epsilon(0.01));
    CHECK(right == test::near(40).epsilon(0.02));
}

TEST_CASE(
    "rotation: squad over evenly spaced keys about one axis is slerp" * technique("anim.squad")) {
    const Quat inner_30 = squad_point(about_z(0), about_z(30), about_z(60));
    const Quat inner_60 = squad_point(about_z(30), about_z(60), about_z(90));
    CHECK(apart(inner_30, about_z(30)) < 1e-6f);
    const Quat q = squad(about_z(30), inner_30, inner_60, about_z(60), 0.25f);
    CHECK(angle_of(q) == test::near(37.5).epsilon(1e-5));
}

TEST_CASE(
    "rotation: squad has no corner at a key where slerp has one, and turns with its keys"
    * technique("anim.squad")) {
    Quats quats;
    double largest_corner = 0;
    for (int i = 0; i < 50; ++i) {
        std::array<Quat, 5> q = {
            quats.next(), quats.next(), quats.next(), quats.next(), quats.next()};
        align_rotations(q);
        std::array<Quat, 5> inner;
        for (std::size_t k = 1; k < 4; ++k) {
            inner[k] = squad_point(q[k - 1], q[k], q[k + 1]);
        }
        constexpr float kStep = 2e-3f;
        const auto corner = [&](auto&& before, auto&& after) {
            // Second-order differences from one side each.
            const Quat left =
                (3.0f * q[2] - 4.0f * before(1 - kStep) + before(1 - 2 * kStep)) / (2 * kStep);
            const Quat right =
                (-3.0f * q[2] + 4.0f * after(kStep) - after(2 * kStep)) / (2 * kStep);
            return apart(left, right);
        };
        const auto first = [&](float u) { return squad(q[1], inner[1], inner[2], q[2], u); };
        const auto second = [&](float u) { return squad(q[2], inner[2], inner[3], q[3], u); };
        CHECK(corner(first, second) < 5e-3f);
        largest_corner = std::max<double>(
            largest_corner, corner(
                                [&](float u) { return slerp_along(q[1], q[2], u); },
                                [&](float u) { return slerp_along(q[2], q[3], u); }));
        const Quat p = quats.next();
        for (const float u : {0.2f, 0.7f}) {
            CHECK(glm::length(first(u)) == test::near(1).epsilon(1e-5));
            const Quat turned_first = squad(p * q[1], p * inner[1], p * inner[2], p * q[2], u);
            CHECK(apart(turned_first, p * first(u)) < 3e-6f);
        }
    }
    CHECK(largest_corner > 0.5);
}
