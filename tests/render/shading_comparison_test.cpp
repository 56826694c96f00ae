#include "content/bake/image_compare.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shading_comparison.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace limn::test::shading_comparison_test {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 64;
constexpr int kLabelRows = 20;  ///< of the names at the lower border, of dots of one pixel

/// A coarse ball with a highlight, which each method of shading shows otherwise.
struct ComparisonScene : Scene {
    ComparisonScene() {
        const MaterialId shiny = add(Material{
            .shading = ShadingModel::Blinn,
            .base_color = {0.5f, 0.3f, 0.2f, 1},
            .specular = Vec3(0.5f),
            .shininess = 20});
        place(add(make_ball(4)), shiny, at({0, 0, 0}));
        shine(
            PointLight{.intensity = kPi, .radius = 100, .attenuation = {.falloff = Falloff::None}},
            at({0.5f, 0.8f, 2.5f}));
    }
    gpu::FloatImage by(ShadingRate rate) {
        world.remove_resource<ShadingComparison>();
        world.insert_resource(Rendering{.shading = rate});
        return radiance(view);
    }
    gpu::FloatImage compared(const ShadingComparison& comparison, ShadingRate left) {
        world.insert_resource(Rendering{.shading = left});
        world.insert_resource(comparison);
        return radiance(view);
    }
    RenderView view = look({0, 0, 2}, {0, 0, 0}, kWidth, kHeight);
};

ColorImage colors(const gpu::FloatImage& image) {
    ColorImage result = {.width = image.width, .height = image.height, .pixels = {}};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Vec3 c(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
            result.pixels.push_back(glm::clamp(c, Vec3(0), Vec3(1)));
        }
    }
    return result;
}

/// Programs of a comparison differ from those of a method alone, and compilers for hardware may
/// fuse other operations in each.
float rounding() {
    return shared_device().caps().software ? 0.0f : 1e-6f;
}

/// As shading_comparison.frag stores what is displayed.
float srgb_decoded(float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

TEST_CASE_FIXTURE(
    ComparisonScene,
    "shading comparison: each side of the divider is the image of its own method") {
    struct Pair {
        ShadingRate left, right;
    };
    for (const auto& [one, other] :
         {Pair{ShadingRate::Vertex, ShadingRate::Pixel},
          Pair{ShadingRate::BlinnMap, ShadingRate::Environment}}) {  // each reads its own texture
        const gpu::FloatImage left = by(one);
        const gpu::FloatImage right = by(other);
        for (const float divider : {0.25f, 0.6f}) {
            const gpu::FloatImage both = compared({.right = other, .divider = divider}, one);
            const int edge = static_cast<int>(divider * kWidth);
            float largest = 0;
            for (int y = 8; y < kHeight - kLabelRows; ++y) {
                for (int x = 0; x < kWidth; ++x) {
                    if (std::abs(x - edge) > 16) {  // the divider with its handle
                        const gpu::FloatImage& side = x < edge ? left : right;
                        largest = std::max(largest, std::abs(both.at(x, y, 0) - side.at(x, y, 0)));
                    }
                }
            }
            CHECK(largest <= rounding());
        }
        CHECK(largest_difference(colors(left), colors(right)).difference > 0.1f);
    }
}

TEST_CASE_FIXTURE(
    ComparisonScene,
    "shading comparison: methods with and without a geometry shader leave no holes") {
    place(add(make_ball(40)), MaterialId{0}, at({1.3f, -0.4f, -0.7f}));
    view = look({0.7f, 0.6f, 2.1f}, {0.3f, 0, 0}, 320, 240);
    struct Pair {
        ShadingRate left, right;
    };
    for (const auto& [left, right] :
         {Pair{ShadingRate::Quadratic, ShadingRate::Pixel},
          Pair{ShadingRate::Pixel, ShadingRate::Cubic}}) {
        const gpu::FloatImage alone = by(right);
        const gpu::FloatImage both = compared({.right = right, .divider = 0}, left);
        int different = 0;
        for (int y = 8; y < view.height - kLabelRows; ++y) {
            for (int x = 24; x < view.width; ++x) {  // right of the divider with its handle
                different += std::abs(both.at(x, y, 0) - alone.at(x, y, 0)) <= rounding() ? 0 : 1;
            }
        }
        CHECK(different == 0);
    }
}

TEST_CASE_FIXTURE(
    ComparisonScene,
    "shading comparison: a difference is that of 8-bit images to the power 1/10, times the gain"
        * technique("fakephong.metric-diffimage")) {
    const auto rounded = [](ColorImage image) {
        for (Vec3& c : image.pixels) {
            c = glm::round(255.0f * c) / 255.0f;
        }
        return image;
    };
    const ColorImage left = rounded(colors(by(ShadingRate::Quadratic)));
    const ColorImage right = rounded(colors(by(ShadingRate::Pixel)));
    for (const float gain : {1.0f, 3.0f}) {
        const ShadingComparison comparison = {
            .right = ShadingRate::Pixel, .image = ComparisonImage::Difference, .gain = gain};
        const gpu::FloatImage found = compared(comparison, ShadingRate::Quadratic);
        const ColorImage wanted = enhanced_difference(left, right);
        float largest = 0;
        for (int y = 0; y < kHeight - kLabelRows; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const float difference = wanted.pixels[static_cast<std::size_t>(y * kWidth + x)].y;
                const float shown = std::min(1.0f, difference * std::pow(gain, 0.1f));
                largest = std::max(largest, std::abs(found.at(x, y, 1) - srgb_decoded(shown)));
            }
        }
        CHECK(largest < 1e-3f);
    }
}

TEST_CASE_FIXTURE(
    ComparisonScene, "shading comparison: a method does not differ from itself, lit a second time"
                         * technique("fakephong.metric-diffimage")) {
    for (int i = 0; i < kShadingRates; ++i) {
        const auto rate = static_cast<ShadingRate>(i);
        const gpu::FloatImage found =
            compared({.right = rate, .image = ComparisonImage::Difference}, rate);
        float largest = 0;
        for (int y = 0; y < kHeight - kLabelRows; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                largest = std::max(largest, found.at(x, y, 0));
            }
        }
        CHECK(largest == 0);
    }
}

TEST_CASE_FIXTURE(
    ComparisonScene, "shading comparison: the names of both methods stand beside the divider") {
    view = look({0, 0, 2}, {0, 0, 0}, 256, kHeight);
    struct Columns {
        int first = 256, last = -1, dots = 0;
    };
    // Orange on the left and blue on the right are the colors of no surface here.
    const auto labeled = [&](ShadingRate left, ShadingRate right, bool orange) {
        const gpu::FloatImage image = compared({.right = right}, left);
        Columns columns;
        for (int y = kHeight - kLabelRows; y < kHeight; ++y) {
            for (int x = 0; x < 256; ++x) {
                const float redness = image.at(x, y, 0) - image.at(x, y, 2);
                if (orange ? redness > 0.5f : redness < -0.5f) {
                    columns.first = std::min(columns.first, x);
                    columns.last = std::max(columns.last, x);
                    ++columns.dots;
                }
            }
        }
        return columns;
    };
    const Columns vertex = labeled(ShadingRate::Vertex, ShadingRate::Taylor, true);
    CHECK(vertex.last < 128 - 8);
    CHECK(vertex.last - vertex.first + 1 == 6 * 6 - 1);  // v e r t e x
    const Columns taylor = labeled(ShadingRate::Vertex, ShadingRate::Taylor, false);
    CHECK(taylor.first > 128 + 8);
    CHECK(taylor.dots == 11 + 14 + 14 + 10 + 12 + 9);  // t a y l o r
    // A name on either side has as many dots, and another name has others.
    CHECK(labeled(ShadingRate::Taylor, ShadingRate::Pixel, true).dots == taylor.dots);
    CHECK(labeled(ShadingRate::Pixel, ShadingRate::Vertex, true).dots != taylor.dots);
    CHECK(labeled(ShadingRate::NormalsSpherical, ShadingRate::Pixel, true).first > 0);
}

TEST_CASE_FIXTURE(
    ComparisonScene, "scanline plot: each column has its curve at the brightness of its pixel"
                         * technique("fakephong.metric-scanline")) {
    const gpu::FloatImage plain = by(ShadingRate::Pixel);
    const ScanlinePlot plot = {.row = 0.75f, .height = 0.5f};
    world.insert_resource(plot);
    const gpu::FloatImage marked = radiance(view);
    const std::vector<float> wanted =
        scanline(colors(plain), kHeight - 1 - static_cast<int>(plot.row * kHeight));
    CHECK(*std::max_element(wanted.begin(), wanted.end()) > 0.2f);
    const int rows = static_cast<int>(plot.height * kHeight);
    for (int x = 2; x + 2 < kWidth; ++x) {
        // The reddest row of the column: only the curve is orange.
        int reddest = 0;
        for (int i = 0; i < rows - 1; ++i) {
            const auto redness = [&](int row) {
                const int y = kHeight - 1 - row;
                return marked.at(x, y, 0) - marked.at(x, y, 2);
            };
            reddest = redness(i) > redness(reddest) ? i : reddest;
        }
        // A steep curve passes many rows between its neighbors.
        const auto height_of = [&](int column) {
            return static_cast<float>(rows)
                   * (0.12f + 0.76f * wanted[static_cast<std::size_t>(column)]);
        };
        const auto [low, high] = std::minmax({height_of(x - 1), height_of(x), height_of(x + 1)});
        CHECK(static_cast<float>(reddest) + 0.5f > low - 1.1f);
        CHECK(static_cast<float>(reddest) + 0.5f < high + 1.1f);
    }
    float above = 0;  // of the plot nothing is changed but the dashed row
    for (int y = 0; y < kHeight - rows; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            if (y != kHeight - 1 - static_cast<int>(plot.row * kHeight)) {
                above = std::max(above, std::abs(marked.at(x, y, 0) - plain.at(x, y, 0)));
            }
        }
    }
    CHECK(above == 0);
}

}  // namespace limn::test::shading_comparison_test
