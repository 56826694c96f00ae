#include "bench/oracles/glow_oracle.h"
#include "ecs/base/rng.h"
#include "render/gpu/readback.h"
#include "render/lens/separable_blur.h"
#include "tests/near.h"
#include "tests/render/render_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <numeric>

namespace limn::test::separable_blur_test {
namespace {

using oracle::LightImage;

constexpr int kSide = 24;
constexpr BlurKernel kBox = {1 / 7.f, 1 / 7.f, 1 / 7.f, 1 / 7.f, 1 / 7.f, 1 / 7.f, 1 / 7.f};
constexpr BlurKernel kAskew = {0.3f, 0.05f, 0.1f, 0.2f, 0.05f, 0.05f, 0.25f};

LightImage blurred(
    const LightImage& picture, const BlurKernel& kernel,
    BlurOrder order = BlurOrder::HorizontalFirst) {
    static const SeparableBlur blur = *create_separable_blur(shared_device());
    static FrameGraph graph(shared_device());
    std::vector<Vec4> texels;
    for (int y = picture.height - 1; y >= 0; --y) {
        for (int x = 0; x < picture.width; ++x) {
            texels.emplace_back(Vec3(picture.at(x, y)), 1.0f);
        }
    }
    gpu::Texture source(
        "source", {.format = GL_RGBA32F, .width = picture.width, .height = picture.height});
    source.upload<Vec4>(texels, GL_RGBA, GL_FLOAT);
    graph.begin_frame();
    const TextureId made =
        blur_separable(graph, blur, "blur", graph.import("source", source), kernel, order);
    graph.keep(made);
    graph.execute();
    CHECK(graph.stats().passes_run == 2);
    const gpu::FloatImage image = gpu::read_floats(*graph.texture(made));
    LightImage out = oracle::make_black_image(picture.width, picture.height);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            out.pixels[y * picture.width + x] = {
                image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
        }
    }
    return out;
}

LightImage noise() {
    LightImage picture = oracle::make_black_image(kSide, kSide);
    Random random(3, 0, 0, 0);
    for (glm::dvec3& pixel : picture.pixels) {
        pixel.x = random.uniform(0.0f, 1.0f);
        pixel.y = random.uniform(0.0f, 1.0f);
        pixel.z = random.uniform(0.0f, 1.0f);
    }
    return picture;
}

double largest_difference(const LightImage& a, const LightImage& b, int border = 0) {
    double largest = 0;
    for (int y = border; y < a.height - border; ++y) {
        for (int x = border; x < a.width - border; ++x) {
            const glm::dvec3 d = glm::abs(a.at(x, y) - b.at(x, y));
            largest = std::max({largest, d.x, d.y, d.z});
        }
    }
    return largest;
}

std::array<double, 7> exact(const BlurKernel& kernel) {
    std::array<double, 7> weights{};
    std::copy(kernel.begin(), kernel.end(), weights.begin());
    return weights;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "separable blur: a point becomes the outer product of the weights"
                    * technique("post.separable-blur")) {
    CHECK(std::accumulate(kBinomialKernel.begin(), kBinomialKernel.end(), 0.0) == 1.0);
    LightImage point = oracle::make_black_image(kSide, kSide);
    point.pixels[12 * kSide + 11] = glm::dvec3(1);
    const LightImage made = blurred(point, kBinomialKernel);
    CHECK(made.at(11, 12).y == test::near(0.09765625).epsilon(1e-6));
    CHECK(oracle::sum_of(made).y == test::near(1).epsilon(1e-6));
    CHECK(made.at(11 + 3, 12 - 2).y == test::near(0.015625 * 0.09375).epsilon(1e-5));
    CHECK(blurred(point, kBox).at(11, 12).y == test::near(1.0 / 49).epsilon(1e-6));
}

TEST_CASE_FIXTURE(
    RenderTest, "separable blur: two passes of 7 taps equal the 49 weights in one"
                    * technique("post.separable-blur")) {
    const LightImage picture = noise();
    for (const BlurKernel& kernel : {kBinomialKernel, kBox, kAskew}) {
        // A GPU has its rows from the bottom up: there an image's weights are turned over.
        const LightImage made = blurred(picture, kernel);
        LightImage direct = oracle::make_black_image(kSide, kSide);
        const std::array<double, 7> weights = exact(kernel);
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                for (int j = -3; j <= 3; ++j) {
                    for (int i = -3; i <= 3; ++i) {
                        direct.pixels[y * kSide + x] +=
                            weights[i + 3] * weights[3 - j]
                            * picture.at(
                                std::clamp(x + i, 0, kSide - 1), std::clamp(y + j, 0, kSide - 1));
                    }
                }
            }
        }
        CHECK(largest_difference(made, direct) < 1e-6);
    }
    CHECK(
        largest_difference(
            blurred(picture, kBinomialKernel), oracle::blur_7x7(picture, exact(kBinomialKernel)))
        < 1e-6);
}

TEST_CASE_FIXTURE(
    RenderTest, "separable blur: the order of the axes makes no difference"
                    * technique("post.separable-blur")) {
    const LightImage picture = noise();
    CHECK(
        largest_difference(
            blurred(picture, kAskew), blurred(picture, kAskew, BlurOrder::VerticalFirst), 3)
        < 1e-6);
}

TEST_CASE_FIXTURE(
    RenderTest, "separable blur: a uniform image stays uniform, also at its edges"
                    * technique("post.separable-blur")) {
    LightImage even = oracle::make_black_image(5, 3);
    for (glm::dvec3& pixel : even.pixels) {
        pixel = glm::dvec3(0.7);
    }
    CHECK(largest_difference(blurred(even, kBinomialKernel), even) < 1e-6);
}

}  // namespace limn::test::separable_blur_test
