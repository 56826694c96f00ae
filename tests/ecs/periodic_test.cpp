#include "ecs/components/periodic.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace limn {
namespace {

using test::near;

constexpr Wave kWaves[] = {Wave::Sine, Wave::Triangle, Wave::Square, Wave::Sawtooth};

PeriodicFunction plain(Wave wave) {
    return {.wave = wave, .base = 0, .amplitude = 1};
}

}  // namespace

TEST_CASE(
    "periodic: a sine of 0.5 and 0.5 is at 0.5, 1 and 0 after quarters of a period"
    * technique("engine.periodic")) {
    const PeriodicFunction sine;
    CHECK(evaluate(sine, 0) == near(0.5));
    CHECK(evaluate(sine, 0.25) == near(1));
    CHECK(evaluate(sine, 0.75) == near(0).scale(1));
}

TEST_CASE(
    "periodic: each wave repeats after 1 / frequency, and at no time before"
    * technique("engine.periodic")) {
    for (const Wave wave : kWaves) {
        CAPTURE(static_cast<int>(wave));
        const PeriodicFunction f = {.wave = wave, .phase = 0.3f, .frequency = 4};
        double sooner = 0;
        for (int i = 0; i < 100; ++i) {
            const double t = 0.00731 * i + 0.0001;
            CHECK(evaluate(f, t + 0.25) == near(evaluate(f, t)).scale(1).epsilon(1e-6));
            sooner += std::abs(evaluate(f, t + 0.125) - evaluate(f, t));
        }
        CHECK(sooner > 10);
    }
}

TEST_CASE("periodic: waves at the eighths of a period" * technique("engine.periodic")) {
    const float half = std::sqrt(0.5f);
    const float expected[][8] = {
        {0, half, 1, half, 0, -half, -1, -half},
        {0, 0.5f, 1, 0.5f, 0, -0.5f, -1, -0.5f},
        {1, 1, 1, 1, -1, -1, -1, -1},
        {-1, -0.75f, -0.5f, -0.25f, 0, 0.25f, 0.5f, 0.75f}};
    for (const Wave wave : kWaves) {
        for (int i = 0; i < 8; ++i) {
            CAPTURE(i);
            const float want = expected[static_cast<int>(wave)][i];
            CHECK(evaluate(plain(wave), i / 8.0) == near(want).scale(1).epsilon(1e-6));
            PeriodicFunction shifted = plain(wave);
            shifted.phase = static_cast<float>(i) / 8;
            CHECK(evaluate(shifted, 0) == near(want).scale(1).epsilon(1e-6));
        }
    }
}

TEST_CASE(
    "periodic: without amplitude it is constant, and fractions are clamped"
    * technique("engine.periodic")) {
    for (const double t : {0.0, 0.1, 7.3, 1e9}) {
        CHECK(evaluate(constant_function(0.7f), t) == 0.7f);
    }
    const PeriodicFunction wide = {.base = 0.5f, .amplitude = 3};
    CHECK(evaluate_share(wide, 0.25) == 1);
    CHECK(evaluate_share(wide, 0.75) == 0);
    CHECK(evaluate_share(wide, 0) == near(0.5));
}

TEST_CASE(
    "periodic: after thirty years it is as smooth as in the first second"
    * technique("engine.periodic")) {
    const double years = std::floor(30 * 365.25 * 86400);
    for (const Wave wave : {Wave::Sine, Wave::Triangle, Wave::Sawtooth}) {
        for (int i = 0; i < 200; ++i) {
            const double t = 0.001 * i + 0.0005;
            CHECK(
                evaluate(plain(wave), years + t)
                == near(evaluate(plain(wave), t)).scale(1).epsilon(1e-5));
        }
    }
    double moved = 0;
    float last = evaluate(plain(Wave::Noise), years);
    for (int i = 1; i < 200; ++i) {
        const float now = evaluate(plain(Wave::Noise), years + 0.005 * i);
        CHECK(std::abs(now - last) < 0.1f);
        moved += now != last ? 1 : 0;
        last = now;
    }
    CHECK(moved > 190);
}

TEST_CASE("periodic: noise is smooth where its blocks of 1024 periods meet") {
    const PeriodicFunction noise = plain(Wave::Noise);
    CHECK(
        evaluate(noise, 1024 - 1e-4) == near(evaluate(noise, 1024 + 1e-4)).scale(1).epsilon(2e-3));
    double apart = 0;
    for (int i = 0; i < 50; ++i) {
        apart += std::abs(evaluate(noise, 0.37 + i) - evaluate(noise, 1024.37 + i));
    }
    CHECK(apart > 1);
}

TEST_CASE("periodic: no number or time makes a NaN") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    for (const Wave wave : {Wave::Sine, Wave::Triangle, Wave::Square, Wave::Noise}) {
        for (const float bad : {kNan, kInfinite, -kInfinite, 3e38f}) {
            for (const double t : {0.0, 1e300, static_cast<double>(kNan)}) {
                CHECK(std::isfinite(evaluate({.wave = wave, .base = bad}, t)));
                CHECK(std::isfinite(evaluate({.wave = wave, .amplitude = bad}, t)));
                CHECK(std::isfinite(evaluate({.wave = wave, .phase = bad}, t)));
                CHECK(std::isfinite(evaluate({.wave = wave, .frequency = bad}, t)));
            }
        }
    }
}

}  // namespace limn
