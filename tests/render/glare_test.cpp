#include "render/gpu/readback.h"
#include "render/lens/glare_pass.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::test::glare_test {
namespace {

constexpr int kSide = 128;

/// What the pass adds to black with one pixel of light in the center of four that are one
/// texel of half the size; `second` is the light of another one in a corner.
gpu::FloatImage
glare_of(float light, const Glare& glare, float second = 0, const Vec3& color = {0, 1, 0}) {
    static const GlarePass pass = *create_glare_pass(shared_device());
    static FrameGraph graph(shared_device());
    std::vector<Vec4> texels(kSide * kSide, Vec4(0, 0, 0, 1));
    texels[kSide / 2 * kSide + kSide / 2] = Vec4(light * color, 1);
    texels[3 * kSide + 3].y = second;
    gpu::Texture radiance("radiance", {.format = GL_RGBA32F, .width = kSide, .height = kSide});
    radiance.upload<Vec4>(texels, GL_RGBA, GL_FLOAT);
    graph.begin_frame();
    const TextureId made = draw_glare(graph, pass, glare, graph.import("radiance", radiance));
    graph.keep(made);
    graph.execute();
    gpu::FloatImage image = gpu::read_floats(*graph.texture(made));
    image.pixels[((kSide / 2 - 1) * kSide + kSide / 2) * 4 + 1] -= light;  // rows from the top
    return image;
}

double added(const gpu::FloatImage& image) {
    double sum = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            sum += image.at(x, y, 1);
        }
    }
    return sum;
}

constexpr double kLuminance = 0.67;  // of green

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "glare: below the threshold there is none" * technique("post.glare-heat-haze")) {
    const Glare glare = {.strength = 1, .threshold = 2};
    CHECK(added(glare_of(static_cast<float>(1.99 / kLuminance), glare)) == 0);
    CHECK(added(glare_of(static_cast<float>(2.5 / kLuminance), glare)) > 0);
}

TEST_CASE_FIXTURE(
    RenderTest, "glare: the added light grows with the luminance above the threshold"
                    * technique("post.glare-heat-haze")) {
    const Glare glare = {.strength = 0.5f, .threshold = 1, .length = 0.4f};
    for (const double luminance : {2.0, 3.0, 9.0}) {
        const gpu::FloatImage made = glare_of(static_cast<float>(luminance / kLuminance), glare);
        CHECK(added(made) == test::near(0.5 * (luminance - 1) / kLuminance).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(
    RenderTest,
    "glare: six blades make six streaks, five make ten" * technique("post.glare-heat-haze")) {
    for (const IVec2& expected : {IVec2(4, 4), IVec2(6, 6), IVec2(5, 10)}) {
        const int blades = expected.x;
        const int streaks = expected.y;
        const gpu::FloatImage made =
            glare_of(1000, {.strength = 1, .blades = blades, .length = 0.8f, .rotation = 0.1f});
        constexpr int kAngles = 720;
        std::vector<float> around;
        for (int i = 0; i < kAngles; ++i) {
            const double angle = 2 * static_cast<double>(kPi) * i / kAngles;
            const int x = static_cast<int>(std::lround(64.5 + 28 * std::cos(angle)));
            const int y = static_cast<int>(std::lround(62.5 + 28 * std::sin(angle)));
            around.push_back(made.at(x, y, 1));
        }
        const float half = 0.4f * *std::max_element(around.begin(), around.end());
        int rises = 0;
        for (int i = 0; i < kAngles; ++i) {
            rises += around[i] <= half && around[(i + 1) % kAngles] > half ? 1 : 0;
        }
        CAPTURE(blades);
        CHECK(rises == streaks);
        CHECK(2 * glare_lines({.blades = blades}) == streaks);
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "glare: of white light, red spreads farther than green, and blue less") {
    const gpu::FloatImage made =
        glare_of(1000, {.strength = 1, .blades = 4, .length = 0.8f}, 0, Vec3(1));
    double sums[3] = {};
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            for (int c = 0; c < 3; ++c) {
                // Of the lamp's own pixel glare_of() takes off green.
                const bool lamp = made.at(x, y, 0) > 500;
                sums[c] += lamp ? 0.0 : static_cast<double>(made.at(x, y, c));
            }
        }
    }
    CHECK(sums[0] / sums[1] == test::near(610.0 / 550).epsilon(0.01));
    CHECK(sums[2] / sums[1] == test::near(465.0 / 550).epsilon(0.01));
}

TEST_CASE_FIXTURE(RenderTest, "glare: NaN never spreads") {
    const float kNan = std::numeric_limits<float>::quiet_NaN();
    const bool half_floats = device().caps().profile == gpu::Profile::Gpu;  // have none
    for (const float broken : {kNan, std::numeric_limits<float>::infinity()}) {
        const gpu::FloatImage made = glare_of(10, {.strength = 1}, broken);
        int count = 0;
        for (const float value : made.pixels) {
            count += std::isfinite(value) ? 0 : 1;
        }
        CHECK(count == (half_floats ? 0 : 1));
    }
}

TEST_CASE_FIXTURE(Scene, "glare: switched off, it adds no pass, and the image is bit-identical") {
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {9, 9, 9, 1}}), at({0, 0, 0}));
    const RenderView view = look({0, 0, 3}, {0, 0, 0}, 40, 32);
    const gpu::FloatImage without = radiance(view);
    world.insert_resource(Glare{.strength = 0});
    CHECK(radiance(view).pixels == without.pixels);
    CHECK(!frame_graph(shared_renderer()).was_run("glare"));
    world.insert_resource(Glare{.strength = 1});
    CHECK(radiance(view).pixels != without.pixels);
}

}  // namespace limn::test::glare_test
