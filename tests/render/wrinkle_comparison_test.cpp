// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/wrinkle_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/wrinkle_comparison.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::test::wrinkle_comparison_test {
namespace {

constexpr int kWide = 256;
constexpr int kHigh = 128;
constexpr int kLabelRows = 48;  // at the lower border

const std::vector<WrinkleMethod> kAll = {WrinkleMethod::None,        WrinkleMethod::Alpha,
                                         WrinkleMethod::Directional, WrinkleMethod::Bump,
                                         WrinkleMethod::Sphere,      WrinkleMethod::Isometric,
                                         WrinkleMethod::Blend,       WrinkleMethod::Photo};

/// Compressed skin that fills the image, under a light from the side.
struct ColumnScene : WrinkleScene {
    ColumnScene() {
        shine(DirectionalLight{.illuminance = 3}, look_at({1, 2, 3}, {0, 0, 0}));
        // A slope that faces down the map, which every method shows.
        material.wrinkle_texture.image = add(ImageData{
            .name = "slope", .width = 1, .height = 1, .pixels = {128, 128 - 60, 240, 255}});
    }

    gpu::FloatImage by(WrinkleMethod method) {
        world.remove_resource<WrinkleComparison>();
        return image_of(method);
    }
    gpu::FloatImage columns(const WrinkleComparison& comparison) {
        world.insert_resource(comparison);
        return image_of(WrinkleMethod::Bump);
    }
    gpu::FloatImage image_of(WrinkleMethod method) {
        const Entity entity = square({.method = method, .lambda = 1.05f, .share = 1}, 0.2f);
        gpu::FloatImage image = radiance(wide);
        world.destroy(entity);
        return image;
    }
    RenderView wide = look({0, 0, 0.4f}, {0, 0, 0}, kWide, kHigh);
};

float largest_difference(const gpu::FloatImage& a, const gpu::FloatImage& b, int from, int to) {
    float largest = 0;
    for (int y = 0; y < kHigh - kLabelRows; ++y) {
        for (int x = from; x < to; ++x) {
            for (int c = 0; c < 3; ++c) {
                largest = std::max(largest, std::abs(a.at(x, y, c) - b.at(x, y, c)));
            }
        }
    }
    return largest;
}

}  // namespace

TEST_CASE_FIXTURE(
    ColumnScene, "wrinkle comparison: each column is the image of its own method"
                     * technique("wrinkle.comparison")) {
    const gpu::FloatImage all = columns({.methods = kAll});
    const int width = kWide / static_cast<int>(kAll.size());
    const gpu::FloatImage smooth = by(WrinkleMethod::None);
    for (std::size_t i = 0; i < kAll.size(); ++i) {
        CAPTURE(static_cast<int>(kAll[i]));
        const int left = static_cast<int>(i) * width;
        const gpu::FloatImage alone = by(kAll[i]);
        // Strengths and blended light are stored in a few bits.
        CHECK(largest_difference(all, alone, left + 6, left + width - 6) < 2e-3f);
        CHECK(all.at(left + width / 2, 20, 0) > 0.1f);  // skin
        const float raised = largest_difference(all, smooth, left + 6, left + width - 6);
        CHECK((raised > 0.02f) == (kAll[i] != WrinkleMethod::None));
    }
}

TEST_CASE_FIXTURE(
    ColumnScene,
    "wrinkle comparison: hidden, without a method or with another map it changes nothing"
        * technique("wrinkle.comparison")) {
    const gpu::FloatImage bump = by(WrinkleMethod::Bump);
    CHECK(columns({.shown = false, .methods = kAll}).pixels == bump.pixels);
    CHECK(columns({.methods = {}}).pixels == bump.pixels);
    CHECK(
        columns({.methods = {WrinkleMethod::StrainView, WrinkleMethod::Model}}).pixels
        == bump.pixels);
    // What is drawn by another map stays so.
    world.remove_resource<WrinkleComparison>();
    const gpu::FloatImage strain = image_of(WrinkleMethod::StrainView);
    world.insert_resource(WrinkleComparison{.methods = {WrinkleMethod::Alpha}});
    CHECK(largest_difference(image_of(WrinkleMethod::StrainView), strain, 0, kWide) == 0);
    // More than fit are left out.
    std::vector<WrinkleMethod> many(12, WrinkleMethod::Alpha);
    const WrinkleComparison too_many = {.methods = many};
    CHECK(wrinkle_columns(&too_many).size() == kMaxWrinkleColumns);
}

TEST_CASE_FIXTURE(
    ColumnScene, "wrinkle comparison: the name of each method is in its column"
                     * technique("wrinkle.comparison")) {
    struct Dots {
        int count = 0, first = kWide, last = -1;
    };
    const auto dots = [&](const gpu::FloatImage& image, int from, int to) {
        Dots found;
        for (int y = kHigh - kLabelRows; y < kHigh; ++y) {
            for (int x = from; x < to; ++x) {
                if (image.at(x, y, 2) > 0.9f) {  // no skin is as blue here
                    ++found.count;
                    found.first = std::min(found.first, x);
                    found.last = std::max(found.last, x);
                }
            }
        }
        return found;
    };
    const gpu::FloatImage image =
        columns({.methods = {WrinkleMethod::Bump, WrinkleMethod::Alpha, WrinkleMethod::Bump}});
    const int width = kWide / 3;
    const Dots bump = dots(image, 6, width - 6);
    const Dots alpha = dots(image, width + 6, 2 * width - 6);
    const Dots again = dots(image, 2 * width + 6, kWide);
    CHECK(bump.last - bump.first + 1 == 4 * 6 - 1);    // b u m p
    CHECK(alpha.last - alpha.first + 1 == 5 * 6 - 1);  // a l p h a
    CHECK(bump.count == again.count);
    CHECK(bump.count != alpha.count);
    CHECK(bump.count > 30);
    CHECK(dots(by(WrinkleMethod::Bump), 0, kWide).count == 0);
}

}  // namespace limn::test::wrinkle_comparison_test
