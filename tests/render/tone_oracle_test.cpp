#include "bench/oracles/tone_oracle.h"
#include "render/lens/statistics_pass.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

// The printed numbers and laws of the spec entries hdr.*, of the double-precision formulas that the
// GPU is held against in picture_statistics_test, tone_map_test and dodge_burn_test.

namespace limn::oracle::tone_oracle_test {
namespace {

std::vector<double> log_ramp(double least, double stops, int count) {
    std::vector<double> ramp;
    for (int i = 0; i < count; ++i) {
        ramp.push_back(least * std::exp2(stops * i / (count - 1)));
    }
    return ramp;
}

std::vector<double> times(std::vector<double> values, double factor) {
    for (double& value : values) {
        value *= factor;
    }
    return values;
}

}  // namespace

TEST_CASE(
    "hdr: luminance weights are red 0.27, green 0.67 and blue 0.06, with sum 1"
    * technique("hdr.luminance")) {
    CHECK(luminance({1, 1, 1}) == test::near(1).epsilon(1e-15));
    CHECK(luminance({1, 0, 0}) == 0.27);
    CHECK(luminance({0, 1, 0}) == 0.67);
    CHECK(luminance({0, 0, 1}) == 0.06);
    CHECK(luminance({1, 0.5, 0.25}) == test::near(0.62).epsilon(1e-15));
    CHECK(luminance({8, 4, 2}) == test::near(8 * luminance({1, 0.5, 0.25})).epsilon(1e-15));
}

TEST_CASE(
    "hdr: the log-average matches the formula, and is below the mean"
    * technique("hdr.log-average")) {
    CHECK(log_average(std::vector<double>(10, 0.5), 1e-4) == test::near(0.5 + 1e-4).epsilon(1e-12));
    CHECK(log_average(std::vector<double>{1, 100}, 0) == test::near(10).epsilon(1e-12));
    CHECK(log_average(std::vector<double>(4, 0.0), 1e-4) == test::near(1e-4).epsilon(1e-12));
    const std::vector<double> ramp = log_ramp(0.01, 12, 100);
    double mean = 0;
    for (const double l : ramp) {
        mean += l / 100;
    }
    CHECK(log_average(ramp, 1e-4) <= mean + 1e-4);
    CHECK(log_average(times(ramp, 7), 0) == test::near(7 * log_average(ramp, 0)).epsilon(1e-12));
}

TEST_CASE(
    "hdr: the dynamic range is a ratio without unit, and 1 for a black image"
    * technique("hdr.dynamic-range")) {
    const std::vector<double> two = {0.01, 1000};
    CHECK(dynamic_range(two) == test::near(1e5).epsilon(1e-12));
    CHECK(dynamic_range(times(two, 123)) == test::near(1e5).epsilon(1e-12));
    CHECK(dynamic_range(std::vector<double>(9, 0.0)) == 1);
    CHECK(dynamic_range(std::vector<double>{}) == 1);
    std::vector<double> codes;
    for (int i = 0; i < 256; ++i) {
        codes.push_back(i / 255.0);
    }
    CHECK(dynamic_range(codes) <= 255 + 1e-9);
    // One pixel in ten thousand does not decide.
    std::vector<double> spike(10000, 1.0);
    spike[5000] = 1e4;
    CHECK(dynamic_range(spike, 0.001) == 1);
    CHECK(dynamic_range(spike) == 1e4);
}

TEST_CASE(
    "hdr: scaled by the key, the log-average is the key in any unit of light"
    * technique("hdr.key-scale")) {
    const std::vector<double> ramp = log_ramp(0.02, 10, 64);
    const double scale = 0.18 / log_average(ramp, 0);
    CHECK(log_average(times(ramp, scale), 0) == test::near(0.18).epsilon(1e-12));
    const std::vector<double> bright = times(ramp, 1000);
    CHECK(0.18 / log_average(bright, 0) * bright[5] == test::near(scale * ramp[5]).epsilon(1e-12));
    const double factor = 0.18 / log_average(std::vector<double>{1, 100}, 0);
    CHECK(factor * 1 == test::near(0.018).epsilon(1e-12));
    CHECK(factor * 100 == test::near(1.8).epsilon(1e-12));
}

TEST_CASE(
    "hdr: compression has its printed values, is monotonic and stays below 1"
    * technique("hdr.compress")) {
    const double known[][2] = {{0, 0},   {0.18, 0.152542}, {1, 0.5},          {3, 0.75},
                               {9, 0.9}, {99, 0.99},       {0.018, 0.017682}, {1.8, 0.642857}};
    for (const auto& [l, shown] : known) {
        CHECK(compress(l) == test::near(shown).epsilon(3e-5));
    }
    CHECK((compress(1e-9) - compress(0)) / 1e-9 == test::near(1).epsilon(1e-6));
    double last = -1;
    for (double l = 0; l < 65504; l = 1.3 * l + 0.001) {
        CHECK(compress(l) > last);
        CHECK(compress(l) < 1);
        last = compress(l);
    }
    CHECK(compress(0.18, 4) == test::near(0.154258));
    CHECK(compress(1, 4) == test::near(0.53125));
    CHECK(compress(4, 4) == test::near(1));
    CHECK(compress(5, 1e9) == test::near(compress(5)).epsilon(1e-12));
}

TEST_CASE(
    "hdr: gamma encoding and decoding are inverse, and curved between 0 and 1"
    * technique("hdr.gamma")) {
    for (const double gamma : {2.2, 2.8}) {
        for (double x = 0; x <= 1; x += 0.125) {
            CHECK(gamma_display(gamma_encode(x, gamma), gamma) == test::near(x).epsilon(1e-12));
        }
        CHECK(gamma_encode(0, gamma) == 0);
        CHECK(gamma_encode(1, gamma) == 1);
    }
    CHECK(gamma_encode(0.5) == test::near(0.729740));
    CHECK(gamma_display(0.5) == test::near(0.217638));
    CHECK(gamma_encode(0.5, 2.8) == test::near(0.780709));
    CHECK(gamma_encode(0.5) / gamma_encode(0.25) == test::near(1.3704).epsilon(1e-4));
    CHECK(gamma_encode(-1) == 0);
}

TEST_CASE(
    "hdr: the knee has its printed values, increases with light, decreases with contrast"
    * technique("hdr.tonemap-shader")) {
    const double known[][4] = {
        {0, 0, 0, 0},
        {0.01, 0.041099, 0.041090, 0.041006},
        {0.18, 0.152882, 0.152263, 0.147162},
        {0.5, 0.243230, 0.240537, 0.221131},
        {1, 0.333300, 0.326102, 0.282157},
        {2, 0.456724, 0.437911, 0.347856},
        {5, 0.692655, 0.629724, 0.434461},
        {100, 2.7029, 1.4124, 0.667892}};
    for (const auto& [c, none, some, much] : known) {
        CHECK(knee_map(c, 0, {.contrast = 0}) == test::near(none).epsilon(5e-5));
        CHECK(knee_map(c, 0, {.contrast = 0.1}) == test::near(some).epsilon(5e-5));
        CHECK(knee_map(c, 0, {.contrast = 1}) == test::near(much).epsilon(5e-5));
    }
    CHECK(knee_map(1, 0, {.exposure = 4, .contrast = 1}) == test::near(0.413779));
    CHECK(knee_map(11.2168, 0, {}) == test::near(1));
    CHECK(knee_map(20.700, 0, {.contrast = 0.1}) == test::near(1));
    CHECK(knee_map(543.4, 0, {.contrast = 0.5}) == test::near(1));
    CHECK(knee_map(74365, 0, {.contrast = 1}) == test::near(1));
    // No contrast is the limit of little.
    CHECK(knee_map(2, 0, {.contrast = 1e-7}) == test::near(knee_map(2, 0, {})).epsilon(1e-6));
    for (double c = 0.001; c < 100; c *= 2) {
        CHECK(knee_map(2 * c, 0, {.contrast = 0.3}) > knee_map(c, 0, {.contrast = 0.3}));
        CHECK(knee_map(c, 0, {.contrast = 0.6}) < knee_map(c, 0, {.contrast = 0.3}));
    }
}

TEST_CASE(
    "hdr: defog subtracts a fraction of the mean color, and never below 0"
    * technique("hdr.defog")) {
    CHECK(knee_map(0.5, 0, {}) == test::near(0.243230).epsilon(5e-5));
    CHECK(knee_map(0.5, 0.01 * 0.3, {}) == test::near(0.242566));
    CHECK(knee_map(0.001, 0.01 * 0.3, {}) == 0);
    CHECK(knee_map(0.7, 0.01 * 0.7, {}) == test::near(knee_map(0.99 * 0.7, 0, {})).epsilon(1e-12));
}

TEST_CASE("hdr: eye adaptation does not depend on the frame rate") {
    CHECK(adaptation_blend(0.5f, 0.5f) == test::near(1 - std::exp(-1.0)));
    CHECK(adaptation_blend(0.5f, 0) == 0);
    CHECK(adaptation_blend(0, 0.01f) == 1);
    double left = 1;
    for (int i = 0; i < 30; ++i) {
        left *= 1 - adaptation_blend(0.5f, 1.0f / 30);
    }
    CHECK(1 - left == test::near(adaptation_blend(0.5f, 1.0f)).epsilon(1e-4));
}

}  // namespace limn::oracle::tone_oracle_test
