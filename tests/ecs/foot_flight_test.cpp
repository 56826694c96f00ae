#include "ecs/base/foot_flight.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::foot_flight_test {

using test::near;

TEST_CASE("foot flight: the curve has the values of the book" * technique("char.foot-flight")) {
    CHECK(flight_curve(0) == 0);
    CHECK(flight_curve(0.5f * kPi) == near(1).epsilon(1e-5));
    CHECK(flight_curve(kPi) == near(2).epsilon(1e-5));
    CHECK(flight_curve(1.5f * kPi) == near(1.707107).epsilon(1e-5));
    CHECK(flight_curve(2 * kPi) == near(1).epsilon(1e-5));
    CHECK(flight_curve(2.5f * kPi) == near(0.292893).epsilon(1e-4));
    CHECK(std::abs(flight_curve(3 * kPi)) < 1e-5f);
}

TEST_CASE(
    "foot flight: its mean is half of its peak, and it starts, peaks and ends without slope"
    * technique("char.foot-flight")) {
    double sum = 0;
    constexpr int kSamples = 3000;
    for (int i = 0; i < kSamples; ++i) {
        const float s = (static_cast<float>(i) + 0.5f) / kSamples;
        sum += static_cast<double>(flight_height(s));
        CHECK(flight_height(s) <= 2.0f);
    }
    CHECK(sum / kSamples == near(1).epsilon(1e-4));
    constexpr float kThird = 1.0f / 3;
    constexpr float kSmall = 1e-3f;
    CHECK(std::abs(flight_height(kSmall)) < 1e-4f);
    CHECK(std::abs(flight_height(1 - kSmall)) < 1e-4f);
    CHECK(2 - flight_height(kThird - kSmall) < 1e-4f);
    CHECK(2 - flight_height(kThird + kSmall) < 1e-4f);
    // The curvature drops to a quarter at the peak: 1 and 0.25 per (1/3 pi)^2.
    const auto drop = [&](float away) { return 2 - flight_height(kThird + away); };
    CHECK(drop(-0.02f) / drop(0.02f) == near(4).epsilon(0.02));
}

TEST_CASE(
    "foot flight: with a plateau a foot is level on its way down" * technique("char.foot-flight")) {
    for (const float plateau : {0.3f, 1.0f}) {
        CHECK(flight_height(0, plateau) == 0);
        CHECK(flight_height(1.0f / 3, plateau) == near(2).epsilon(1e-5));
        CHECK(std::abs(flight_height(1, plateau)) < 1e-5f);
        float last = 2;
        for (float s = 0.34f; s < 1; s += 0.01f) {
            const float height = flight_height(s, plateau);
            CHECK(height < last + 1e-6f);
            CHECK(last - height < 0.1f);  // without a jump
            last = height;
        }
    }
    // In the middle of the descent it is steep without, and flat with a plateau.
    const auto slope = [](float plateau) {
        return flight_height(0.69f, plateau) - flight_height(0.71f, plateau);
    };
    CHECK(slope(0) > 0.08f);
    CHECK(slope(1) < 0.02f);
}

}  // namespace limn::foot_flight_test
