#include "ecs/base/repeatable_math.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace limn;

TEST_CASE("repeatable math: the reciprocal and the inverse root are right to 3e-7") {
    double reciprocal = 0;
    double root = 0;
    for (double x = 1e-30; x < 1e30; x *= 1.0371) {
        const auto f = static_cast<float>(x);
        reciprocal =
            std::max(reciprocal, std::abs(static_cast<double>(repeatable_reciprocal(f)) * f - 1.0));
        root = std::max(
            root,
            std::abs(static_cast<double>(repeatable_inverse_root(f)) * std::sqrt(double{f}) - 1.0));
        CHECK(repeatable_reciprocal(-f) == -repeatable_reciprocal(f));
    }
    CHECK(reciprocal < 3e-7);
    CHECK(root < 3e-7);
}

TEST_CASE("repeatable math: the cosine and the sine are right to 1.5e-7 up to 1.2 rad") {
    double error = 0;
    for (double angle = -1.2; angle <= 1.2; angle += 0.001) {
        const Vec2 found = repeatable_cos_sin(static_cast<float>(angle));
        const auto exact = static_cast<double>(static_cast<float>(angle));
        error = std::max(error, std::abs(static_cast<double>(found.x) - std::cos(exact)));
        error = std::max(error, std::abs(static_cast<double>(found.y) - std::sin(exact)));
    }
    CHECK(error < 1.5e-7);
    CHECK(repeatable_cos_sin(0) == Vec2(1, 0));
}
