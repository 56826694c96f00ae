#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/animation/graph/inertial_offset.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::inertial_offset_test {

using namespace limn::test;

namespace {

/// The polynomial of Bollo (GDC 2018) as published, in double precision; x0 > 0.
struct Published {
    double x0, v0, t1, a0, a, b, c;

    Published(double offset, double rate, double duration) : x0(offset), v0(std::min(rate, 0.0)) {
        t1 = v0 < 0 ? std::min(duration, -5 * x0 / v0) : duration;
        a0 = std::max(0.0, -(8 * v0 * t1 + 20 * x0) / (t1 * t1));
        a = -(a0 * t1 * t1 + 6 * v0 * t1 + 12 * x0) / (2 * std::pow(t1, 5));
        b = (3 * a0 * t1 * t1 + 16 * v0 * t1 + 30 * x0) / (2 * std::pow(t1, 4));
        c = -(3 * a0 * t1 * t1 + 12 * v0 * t1 + 20 * x0) / (2 * std::pow(t1, 3));
    }
    [[nodiscard]] double at(double t) const {
        return t >= t1 ? 0.0 : ((((a * t + b) * t + c) * t + a0 / 2) * t + v0) * t + x0;
    }
};

constexpr float kRates[] = {0.0f, -0.2f, -1.0f, -4.0f, -20.0f, -300.0f, 3.0f};

Quat random_rotation(Random& random) {
    const Vec3 axis = random.direction();
    const float angle = random.uniform(0.0f, 2.0f);
    return rotation_about(axis, angle);
}

}  // namespace

TEST_CASE("inertialization: the amplitude is the published polynomial" * technique("char.blend")) {
    for (const float x0 : {0.01f, 0.5f, 2.0f}) {
        for (const float v0 : kRates) {
            for (const float duration : {0.05f, 0.25f, 1.5f}) {
                const Published exact(
                    static_cast<double>(x0), static_cast<double>(v0),
                    static_cast<double>(duration));
                for (int i = 0; i <= 40; ++i) {
                    const float t = duration * static_cast<float>(i) / 40.0f;
                    CHECK(
                        std::abs(
                            static_cast<double>(inertial_amplitude(x0, v0, duration, t))
                            - exact.at(static_cast<double>(t)))
                        < 4e-6 * static_cast<double>(x0));
                }
            }
        }
    }
}

TEST_CASE("inertialization: the amplitude starts at its value and rate and ends at 0 with rate and "
          "acceleration 0") {
    for (const float v0 : {0.0f, -0.5f, -2.0f, -6.0f}) {
        constexpr float kDuration = 0.5f;
        constexpr float kStep = 1e-3f;
        const auto at = [&](float t) {
            return static_cast<double>(inertial_amplitude(1.0f, v0, kDuration, t));
        };
        CHECK(at(0) == 1);
        CHECK(
            (at(kStep) - at(0)) / static_cast<double>(kStep)
            == near(static_cast<double>(v0)).epsilon(0.02).scale(3));
        CHECK(at(kDuration) == 0);
        CHECK(std::abs(at(kDuration - kStep)) < 1e-5);  // like (t1 - t)^3
        CHECK(std::abs(at(kDuration - 10 * kStep)) < 1e-3);
        CHECK(at(kDuration + 1) == 0);
        CHECK(at(-0.01f) == near(1 - 0.01 * static_cast<double>(v0)));
    }
}

TEST_CASE("inertialization: it never overshoots") {
    for (const float v0 : kRates) {
        float last = 1.0f;
        for (int i = 0; i <= 400; ++i) {
            const float x = inertial_amplitude(1.0f, v0, 0.4f, 0.001f * static_cast<float>(i));
            CHECK(x >= 0.0f);
            CHECK(x <= last + 1e-6f);
            last = x;
        }
    }
    // A rate that is too high for the time shortens it.
    CHECK(inertial_amplitude(1.0f, -50.0f, 0.4f, 0.08f) > 0.0f);
    CHECK(inertial_amplitude(1.0f, -50.0f, 0.4f, 0.102f) == 0.0f);
}

TEST_CASE(
    "inertialization: what moves away or across goes on at its rate, and comes back to rest") {
    constexpr float kDuration = 0.5f;
    constexpr float kStep = 1e-3f;
    const auto at = [](float t) { return static_cast<double>(inertial_drift(kDuration, t)); };
    CHECK(at(0) == 0);
    CHECK(at(kStep) / static_cast<double>(kStep) == near(1).epsilon(1e-3));
    CHECK((at(2 * kStep) - 2 * at(kStep)) / 1e-6 == near(0).scale(20).epsilon(0.01));
    CHECK(std::abs(at(kDuration - kStep)) < 1e-6);  // like (t1 - t)^3
    CHECK(at(kDuration) == 0);
    double largest = 0;
    for (float t = 0; t < kDuration; t += kStep) {
        CHECK(at(t) >= 0);
        largest = std::max(largest, at(t));
    }
    CHECK(largest < 0.2 * static_cast<double>(kDuration));
    CHECK(largest > 0.15 * static_cast<double>(kDuration));

    // All of a rate is kept at the beginning, whatever its direction.
    Random random(7, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const Vec3 offset = random.direction();
        const Vec3 rate = 3.0f * random.direction();
        const InertialOffset moving = {offset, rate};
        const Vec3 first = inertial_vector(moving, kDuration, 0);
        CHECK(glm::distance(first, offset) < 1e-6f);
        const Vec3 next = inertial_vector(moving, kDuration, 1e-3f);
        CHECK(glm::distance((next - first) / 1e-3f, rate) < 0.1f);
        CHECK(inertial_vector(moving, kDuration, kDuration) == Vec3(0));
    }
}

TEST_CASE("inertialization: offsets of poses show the old pose first and the new one last") {
    Random random(5, 0, 0, 0);
    constexpr float kInterval = 1.0f / 240.0f;
    for (int i = 0; i < 200; ++i) {
        const Quat shown = random_rotation(random);
        const Quat target = random_rotation(random);
        const InertialOffset turn = inertial_turn(shown, shown, target, target, kInterval);
        const Quat first = apply_turn(turn, target, 0.3f, 0.0f);
        CHECK(std::abs(glm::dot(first, shown)) == near(1).epsilon(1e-6));
        CHECK(glm::length(turn.offset) <= kPi + 1e-5f);
        CHECK(turn.rate == Vec3(0));
        CHECK(apply_turn(turn, target, 0.3f, 0.3f) == target);
        const Vec3 a = random.direction();
        const Vec3 b = random.direction();
        const InertialOffset shift = inertial_shift(a, a, b, b, kInterval);
        CHECK(glm::distance(apply_shift(shift, b, 0.3f, 0.0f), a) < 1e-6f);
        CHECK(apply_shift(shift, b, 0.3f, 0.3f) == b);
    }
}

TEST_CASE(
    "inertialization: the rate of an offset is that of the old pose relative to the new one") {
    constexpr float kInterval = 1.0f / 240.0f;
    const Vec3 axis = glm::normalize(Vec3(1, 2, -1));
    const auto turned = [&](float angle) { return rotation_about(axis, angle); };
    // The old one comes nearer at 2 rad/s, the new one goes to meet it at 1 rad/s.
    const InertialOffset turn = inertial_turn(
        turned(0.8f), turned(0.8f + 2 * kInterval), turned(0.1f), turned(0.1f - kInterval),
        kInterval);
    CHECK(glm::distance(turn.rate, -3.0f * axis) < 3e-3f);
    CHECK(glm::distance(turn.offset, 0.7f * axis) < 1e-5f);
    const InertialOffset shift = inertial_shift(
        Vec3(1, 0, 0), Vec3(1 + 2 * kInterval, 0, 0), Vec3(0), Vec3(-kInterval, 0, 0), kInterval);
    CHECK(glm::distance(shift.rate, Vec3(-3, 0, 0)) < 3e-3f);
}

TEST_CASE("inertialization: equal poses have no offset, opposite ones a finite one") {
    const Quat q = rotation_about({0, 1, 0}, 0.4f);
    CHECK(is_negligible(inertial_turn(q, q, q, q, 0.01f)));
    CHECK(is_negligible(inertial_turn(-q, q, q, -q, 0.01f)));
    CHECK(is_negligible(inertial_shift(Vec3(1), Vec3(2), Vec3(1), Vec3(2), 0.01f)));
    CHECK_FALSE(is_negligible(inertial_shift(Vec3(1), Vec3(2), Vec3(1), Vec3(0), 0.01f)));
    const Quat half = rotation_about({1, 0, 0}, kPi) * q;
    const Quat shown = apply_turn(inertial_turn(half, half, q, q, 0.01f), q, 0.2f, 0.05f);
    CHECK(glm::length(shown) == near(1));
    CHECK(inertial_amplitude(1, 0, 0, 0) == 0.0f);
    CHECK(inertial_amplitude(0, -1, 1, 0) == 0.0f);
}

}  // namespace limn::inertial_offset_test
