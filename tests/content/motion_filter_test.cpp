#include "content/bake/motion/motion_filter.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace limn::motion_filter_test {

using test::near;

namespace {

constexpr double kTwoPi = 6.283185307179586;

std::vector<double> sine(double hertz, double rate, std::size_t count) {
    std::vector<double> samples;
    for (std::size_t i = 0; i < count; ++i) {
        samples.push_back(std::sin(kTwoPi * hertz * static_cast<double>(i) / rate));
    }
    return samples;
}

double amplitude_in_the_middle(const std::vector<double>& samples) {
    double largest = 0;
    for (std::size_t i = samples.size() / 4; i < 3 * samples.size() / 4; ++i) {
        largest = std::max(largest, std::abs(samples[i]));
    }
    return largest;
}

}  // namespace

TEST_CASE(
    "motion filter: constant and linear paths pass unchanged" * technique("char.mocap-cleanup")) {
    for (const std::size_t count : {1, 2, 3, 10, 200}) {
        std::vector<Vec3> path;
        for (std::size_t i = 0; i < count; ++i) {
            path.push_back(Vec3(1, 2, 3) + static_cast<float>(i) * Vec3(0.1f, 0, -0.02f));
        }
        const std::vector<Vec3> before = path;
        low_pass(std::span(path), 60, 6);
        for (std::size_t i = 0; i < count; ++i) {
            CHECK(glm::distance(path[i], before[i]) < 1e-5f);
        }
    }
}

TEST_CASE(
    "motion filter: power is halved at the cutoff, noise above it is gone"
    * technique("char.mocap-cleanup")) {
    const auto gain = [](double hertz) {
        std::vector<double> samples = sine(hertz, 240, 2400);
        low_pass(std::span(samples), 240, 8);
        return amplitude_in_the_middle(samples);
    };
    CHECK(gain(1) == near(1).epsilon(1e-3));
    CHECK(gain(8) == near(std::sqrt(0.5)).epsilon(0.01));
    CHECK(gain(40) < 0.01);
}

TEST_CASE("motion filter: peaks stay at their time" * technique("char.mocap-cleanup")) {
    std::vector<double> bump;
    for (int i = 0; i < 200; ++i) {
        bump.push_back(std::exp(-square((i - 77) / 12.0)));
    }
    std::vector<double> filtered = bump;
    low_pass(std::span(filtered), 100, 6);
    CHECK(std::max_element(filtered.begin(), filtered.end()) - filtered.begin() == 77);
    for (int k = 1; k < 60; ++k) {  // and symmetric
        CHECK(
            filtered[static_cast<std::size_t>(77 + k)]
            == near(filtered[static_cast<std::size_t>(77 - k)]).scale(1).epsilon(1e-6));
    }
    // Noise of a path that bends: nearer to the truth than it was.
    Random random(1, 2, 3, 4);
    double before = 0;
    double after = 0;
    std::vector<double> noisy = bump;
    for (double& sample : noisy) {
        sample += 0.02 * static_cast<double>(random.uniform() - 0.5f);
    }
    std::vector<double> smooth = noisy;
    low_pass(std::span(smooth), 100, 8);
    for (std::size_t i = 0; i < bump.size(); ++i) {
        before += square(noisy[i] - bump[i]);
        after += square(smooth[i] - bump[i]);
    }
    CHECK(after < 0.3 * before);
}

TEST_CASE(
    "motion filter: rotations stay unit, also where signs of quaternions flip"
    * technique("char.mocap-cleanup")) {
    std::vector<Quat> rotations;
    for (int i = 0; i < 100; ++i) {
        const Quat q = rotation_about({0, 1, 0}, 0.1f * static_cast<float>(i));
        rotations.push_back(i % 2 == 0 ? q : -q);
    }
    const std::vector<Quat> before = rotations;
    low_pass(std::span(rotations), 60, 12);
    for (std::size_t i = 0; i < rotations.size(); ++i) {
        CHECK(glm::length(rotations[i]) == near(1));
        CHECK(std::abs(glm::dot(rotations[i], before[i])) > 0.9999f);
        CHECK((i == 0 || glm::dot(rotations[i], rotations[i - 1]) > 0));
    }
}

TEST_CASE(
    "motion filter: a cutoff of half the rate, 0 or NaN changes nothing"
    * technique("char.mocap-cleanup")) {
    const std::vector<double> samples = sine(13, 100, 50);
    for (const double cutoff : {50.0, 1e9, 0.0, -1.0, static_cast<double>(NAN)}) {
        std::vector<double> filtered = samples;
        low_pass(std::span(filtered), 100, cutoff);
        CHECK(filtered == samples);
    }
}

}  // namespace limn::motion_filter_test
