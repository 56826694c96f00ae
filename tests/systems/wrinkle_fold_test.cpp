#include "systems/faces/wrinkle_fold.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace limn::wrinkle_fold_test {

using limn::test::near;

namespace {

/// Slopes of a sine whose steepest slope is 1, over one period.
std::vector<Vec2> sine_slopes(int count = 4096) {
    std::vector<Vec2> slopes;
    for (int i = 0; i < count; ++i) {
        const double phase = 2 * std::numbers::pi * (i + 0.5) / count;
        slopes.emplace_back(0.0f, static_cast<float>(std::cos(phase)));
    }
    return slopes;
}

/// Length of a profile whose slopes are multiplied, relative to its flat length.
double length_of(const std::vector<Vec2>& slopes, double factor) {
    double sum = 0;
    for (const Vec2& slope : slopes) {
        const double size = factor * std::hypot(double{slope.x}, double{slope.y});
        sum += std::sqrt(1 + size * size);
    }
    return sum / static_cast<double>(slopes.size());
}

}  // namespace

TEST_CASE(
    "wrinkle fold: a sine is as high as its elliptic integral says"
    * technique("wrinkle.compression.skin-model")) {
    // Amplitude over wavelength by the fraction of the length that remains (face-facts F).
    struct Row {
        float left, amplitude;
    };
    const std::vector<Row> rows = {
        {0.99f, 0.0321f}, {0.98f, 0.0458f}, {0.97f, 0.0566f}, {0.95f, 0.0744f}, {0.92f, 0.0968f},
        {0.90f, 0.1104f}, {0.85f, 0.1421f}, {0.80f, 0.1730f}, {0.75f, 0.2046f}, {0.70f, 0.2382f}};
    const FoldTable table = make_fold_table(sine_slopes());
    for (const Row& row : rows) {
        CAPTURE(row.left);
        const float steepest = fold_strength(table, 1 / row.left - 1);
        CHECK(steepest / (2 * kPi) == near(row.amplitude).epsilon(4e-3));
    }
}

TEST_CASE(
    "wrinkle fold: any profile keeps its length down to a half of it, to 0.5 %"
    * technique("wrinkle.compression.skin-model")) {
    std::mt19937 random(3);
    std::vector<Vec2> creases;  // steep and rare, over gentle ones
    std::vector<Vec2> noise;
    for (int i = 0; i < 5000; ++i) {
        creases.emplace_back(i % 10 == 0 ? 2.0f : 0.1f, 0.05f);
        const auto value = [&] { return static_cast<float>(random() >> 8) / 16777216.0f - 0.5f; };
        noise.emplace_back(value(), value());
    }
    for (const std::vector<Vec2>& slopes : {sine_slopes(), creases, noise}) {
        const FoldTable table = make_fold_table(slopes);
        for (float e = 0.002f; e < 1; e *= 1.3f) {
            CHECK(length_of(slopes, fold_strength(table, e)) == near(1 + e).epsilon(5e-3));
        }
    }
}

TEST_CASE("wrinkle fold: flat texels are ignored, and a flat map has no folds") {
    std::vector<Vec2> slopes = sine_slopes();
    const FoldTable alone = make_fold_table(slopes);
    slopes.resize(3 * slopes.size(), Vec2{0, 0});
    const FoldTable among_flat = make_fold_table(slopes);
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CHECK(among_flat[i] == near(alone[i]).epsilon(1e-6));
    }
    CHECK(fold_strength(make_fold_table(std::vector<Vec2>(100, Vec2{0, 0})), 0.3f) == 0);
    CHECK(fold_strength(make_fold_table({}), 0.3f) == 0);
}

TEST_CASE(
    "wrinkle fold: neither rest nor stretch folds, nor shortening within the slack"
    * technique("wrinkle.compression.skin-model")) {
    const FoldTable table = make_fold_table(sine_slopes());
    CHECK(fold_strength(table, fold_excess(1, 0, 1)) == 0);
    CHECK(fold_strength(table, fold_excess(1.3f, 0, 1)) == 0);
    CHECK(fold_excess(0.97f * 0.97f, 0.05f, 1) == 0);
    CHECK(fold_excess(0.8f * 0.8f, 0, 1) == near(0.25));
    CHECK(fold_excess(0.8f * 0.8f, 0.05f, 0.2f) == near(1 / 0.97 - 1));
    CHECK(fold_excess(0, 0, 1) == 1);
    float before = -1;
    for (float ratio = 1; ratio >= 0; ratio -= 0.01f) {
        const float strength = fold_strength(table, fold_excess(ratio, 0.03f, 0.5f));
        CHECK(strength >= before);
        before = strength;
    }
}

TEST_CASE("wrinkle fold: a map's slopes are its normals', exactly flat at 128") {
    ImageData map{
        .name = "m", .width = 2, .height = 1, .pixels = {128, 128, 255, 255, 204, 128, 230, 255}};
    const std::vector<Vec2> slopes = wrinkle_slopes(map);
    REQUIRE(slopes.size() == 2);
    CHECK(slopes[0] == Vec2{0, 0});
    CHECK(slopes[1].x == near(-76.0 / 102));
    map.format = PixelFormat::Rgba32F;
    CHECK(wrinkle_slopes(map).empty());
}

}  // namespace limn::wrinkle_fold_test
