#include "bench/oracles/glow_oracle.h"
#include "ecs/components/glow.h"
#include "ecs/components/rendering.h"
#include "render/lens/glow_pass.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace limn::test::glow_test {
namespace {

using oracle::LightImage;

LightImage picture_of(const gpu::FloatImage& image) {
    LightImage picture = oracle::make_black_image(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            picture.pixels[y * image.width + x] = glm::dvec3(rgb_at(image, x, y));
        }
    }
    return picture;
}

const GlowPass& shared_pass() {
    static const GlowPass pass = *create_glow_pass(shared_device());
    return pass;
}

/// Without a scene: what the pass makes of these pixels.
LightImage
glowing(const LightImage& picture, const Glow& glow, const GlowPass& pass = shared_pass()) {
    static FrameGraph graph(shared_device());
    std::vector<Vec4> texels;
    for (int y = picture.height - 1; y >= 0; --y) {  // bottom row first
        for (int x = 0; x < picture.width; ++x) {
            texels.emplace_back(Vec3(picture.at(x, y)), 1.0f);
        }
    }
    gpu::Texture radiance(
        "radiance", {.format = GL_RGBA32F, .width = picture.width, .height = picture.height});
    radiance.upload<Vec4>(texels, GL_RGBA, GL_FLOAT);
    graph.begin_frame();
    const TextureId made = draw_glow(graph, pass, glow, graph.import("radiance", radiance));
    graph.keep(made);
    graph.execute();
    return picture_of(gpu::read_floats(*graph.texture(made)));
}

/// A pixel's worth of light at `position`, spread over the pixels that it covers.
LightImage dot_at(int width, int height, const glm::dvec2& position, double light) {
    LightImage picture = oracle::make_black_image(width, height);
    for (int y = 0; y < height; ++y) {
        const double down = std::max(0.0, 1 - std::abs(y + 0.5 - position.y));
        for (int x = 0; down > 0 && x < width; ++x) {
            const double weight = down * std::max(0.0, 1 - std::abs(x + 0.5 - position.x));
            picture.pixels[y * width + x] = glm::dvec3(weight * light);
        }
    }
    return picture;
}

double green_sum(const LightImage& picture) {
    return oracle::sum_of(picture).y;
}

/// A lamp before the dark.
Entity place_objects(Scene& scene, const Vec3& emission = {9, 4, 2}, float z = 0) {
    const MaterialId bright = scene.add(
        Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}, .emission = emission});
    return scene.place(
        scene.add(make_square()), bright, affine_from({0.2f, -0.1f, z}, {1, 0, 0, 0}, Vec3(0.25f)));
}

std::string pass_names() {
    std::string names;
    for (const PassTiming& timing : frame_graph(shared_renderer()).timings()) {
        names += std::string(timing.name) + '\n';
    }
    return names;
}

}  // namespace

TEST_CASE_FIXTURE(Scene, "glow: switched off, it adds no pass, and the image is bit-identical") {
    place_objects(*this);
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 61, 48);
    static_cast<void>(draw(view));  // what surrounds the scene is mirrored once
    const gpu::FloatImage without = radiance(view);
    const std::string passes = pass_names();
    for (const GlowKind kind : {GlowKind::Lens, GlowKind::Mask}) {
        world.insert_resource(Glow{.kind = kind, .strength = 0});
        CHECK(radiance(view).pixels == without.pixels);
        CHECK(pass_names() == passes);
        world.insert_resource(Glow{.kind = kind, .strength = 0.5f});
        CHECK(radiance(view).pixels != without.pixels);
        CHECK(frame_graph(shared_renderer()).was_run("glow"));
    }
}

TEST_CASE_FIXTURE(Scene, "glow: an accumulated image glows once, with the mean of its samples") {
    place_objects(*this);
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 61, 48);
    const auto accumulated = [&] {
        return picture_of(
            gpu::read_floats(*render_accumulated(shared_renderer(), world, view, 4).radiance));
    };
    const LightImage without = accumulated();
    world.insert_resource(Glow{.strength = 0.5f});
    const LightImage with = accumulated();
    CHECK(with.pixels != without.pixels);
    CHECK(green_sum(with) == test::near(green_sum(without)).epsilon(1e-4));
    CHECK(pass_names().find("accumulate") == std::string::npos);  // of the last frame alone
}

TEST_CASE("glow: the weights of the levels sum to 1, and the last level fades in") {
    for (const float radius : {0.001f, 0.01f, 0.1f, 0.15f, 1.0f}) {
        const std::vector<float> weights = glow_weights({.radius = radius}, 640, 360);
        CHECK(std::accumulate(weights.begin(), weights.end(), 0.0) == test::near(1).epsilon(1e-6));
    }
    std::vector<float> before = glow_weights({.radius = 0.05f}, 640, 360);
    for (float radius = 0.05f; radius < 0.5f; radius *= 1.01f) {
        std::vector<float> weights = glow_weights({.radius = radius}, 640, 360);
        before.resize(weights.size());
        for (std::size_t i = 0; i < weights.size(); ++i) {
            CHECK(std::abs(weights[i] - before[i]) < 0.01f);
        }
        before = weights;
    }
    CHECK(glow_weights({.radius = 1}, 1, 1).size() == 1);
    CHECK(glow_weights({.radius = 1}, 16384, 9216).size() <= 14);
}

TEST_CASE_FIXTURE(
    RenderTest, "glow: light is conserved at any size, also in corners" * technique("post.glow")) {
    for (const IVec2& size :
         {IVec2(64, 48), IVec2(61, 48), IVec2(33, 47), IVec2(1, 1), IVec2(2, 5), IVec2(1, 40)}) {
        for (const glm::dvec2& weight :
             {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0.3, 1), glm::dvec2(0.45, 0.6)}) {
            const glm::dvec2 position = glm::dvec2(0.5) + glm::floor(weight * glm::dvec2(size - 1));
            CAPTURE(size.x);
            CAPTURE(size.y);
            CAPTURE(position.x);
            CAPTURE(position.y);
            const LightImage made =
                glowing(dot_at(size.x, size.y, position, 20), {.strength = 1, .radius = 0.4f});
            CHECK(green_sum(made) == test::near(20).epsilon(1e-4));
        }
    }
}

TEST_CASE_FIXTURE(RenderTest, "glow: a uniform image stays as it is") {
    for (const IVec2& size : {IVec2(40, 24), IVec2(37, 23)}) {
        LightImage even = oracle::make_black_image(size.x, size.y);
        for (glm::dvec3& pixel : even.pixels) {
            pixel = {0.25, 1, 300};
        }
        const LightImage made = glowing(even, {.strength = 0.7f});
        for (const glm::dvec3& pixel : made.pixels) {
            CHECK(pixel.y == test::near(1).epsilon(1e-5));
            CHECK(pixel.z == test::near(300).epsilon(1e-5));
        }
    }
}

TEST_CASE_FIXTURE(RenderTest, "glow: the steps for sizes of 2 : 1 equal those for any size") {
    GlowPass general = shared_pass();
    general.down_twice = general.down;
    general.up_twice = general.up;
    const Glow glow = {.strength = 1, .radius = 0.4f, .firefly = 0};
    for (const glm::dvec2& position :
         {glm::dvec2(0.5, 0.5), glm::dvec2(17.5, 30), glm::dvec2(63, 20.5)}) {
        const LightImage dot = dot_at(64, 48, position, 1000);
        const LightImage made = glowing(dot, glow);
        const LightImage expected = glowing(dot, glow, general);
        for (std::size_t i = 0; i < made.pixels.size(); ++i) {
            CHECK(made.pixels[i].y == test::near(expected.pixels[i].y).epsilon(1e-4).scale(1e-3));
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "glow: a point becomes a round halo, within 5 % at any radius and position"
                    * technique("post.glow")) {
    constexpr int kHeight = 240;
    const Glow glow = {.strength = 1, .radius = 0.1f, .firefly = 0};
    for (const glm::dvec2& position :
         {glm::dvec2(160.5, 120.5), glm::dvec2(163.5, 125.5), glm::dvec2(170.5, 113.5)}) {
        const LightImage made = glowing(dot_at(320, kHeight, position, 100), glow);
        for (const double radius : {1.5, 3.0, 6.0, 9.0, 12.0, 18.0, 24.0}) {
            CAPTURE(radius);
            CHECK(oracle::rotational_spread(made, position, radius) < 0.05);
        }
    }
}

TEST_CASE_FIXTURE(RenderTest, "glow: light falls off with the requested power of the distance") {
    for (const float falloff : {2.0f, 2.4f, 3.0f}) {
        const LightImage made = glowing(
            dot_at(320, 240, {160.5, 120.5}, 100),
            {.strength = 1, .radius = 0.5f, .falloff = falloff, .firefly = 0});
        const double near = made.at(160 + 12, 120).y;
        const double far = made.at(160 + 48, 120).y;
        CHECK(std::log2(near / far) / 2 == test::near(falloff).epsilon(0.1));
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "glow: light of a pixel that moves by an eighth of a pixel does not flicker"
                    * technique("post.glow")) {
    for (const double light : {1.0, 30.0, 5000.0}) {
        double sum = 0;
        double squares = 0;
        for (int i = 0; i <= 16; ++i) {
            const LightImage made = glowing(
                dot_at(96, 64, {40.5 + i / 8.0, 30.5 + i / 16.0}, light), {.strength = 0.5f});
            sum += green_sum(made) / 17;
            squares += green_sum(made) * green_sum(made) / 17;
        }
        CAPTURE(light);
        CHECK(std::sqrt(std::max(squares - sum * sum, 0.0)) < 0.02 * sum);
        CHECK(sum == test::near(light).epsilon(0.005));
    }
}

TEST_CASE_FIXTURE(RenderTest, "glow: a firefly's light stays in its pixel instead of spreading") {
    const Glow glow = {.strength = 0.5f, .firefly = 100};
    const auto spread = [&](double light) {
        const LightImage made = glowing(dot_at(96, 64, {40.5, 30.5}, light), glow);
        return 1 - made.at(40, 30).y / light;  // fraction that left the pixel
    };
    CHECK(spread(1) > 0.45);
    CHECK(spread(1e4) < 0.1 * spread(1));
    // Large lights are none, however bright, but for their rims.
    LightImage sun = oracle::make_black_image(96, 64);
    for (int y = 20; y < 40; ++y) {
        for (int x = 30; x < 50; ++x) {
            sun.pixels[y * 96 + x] = glm::dvec3(1e4);
        }
    }
    CHECK(
        glowing(sun, glow).at(40, 60).y
        > 0.85 * glowing(sun, {.strength = 0.5f, .firefly = 0}).at(40, 60).y);
}

TEST_CASE_FIXTURE(RenderTest, "glow: NaN and infinity never spread" * technique("post.glow")) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const IVec2& size : {IVec2(64, 48), IVec2(63, 47)}) {
        LightImage picture = dot_at(size.x, size.y, {40.5, 30.5}, 10);
        picture.pixels[10 * size.x + 12] = {kNan, 1, 1};
        picture.pixels[20 * size.x + 22] = {1, kInfinity, 1};
        picture.pixels[30 * size.x + 5] = {3e38, 3e38, 3e38};
        const LightImage made = glowing(picture, {.strength = 1, .radius = 0.3f});
        int broken = 0;
        for (int i = 0; i < size.x * size.y; ++i) {
            broken += std::isfinite(made.pixels[i].x + made.pixels[i].y + made.pixels[i].z) ? 0 : 1;
        }
        const bool half_floats = device().caps().profile == gpu::Profile::Gpu;  // have none
        CHECK(broken == (half_floats ? 0 : 2));
        CHECK(made.at(45, 30).y > 0);
        CHECK(made.at(5, 35).y < 65504);
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "glow: it matches the oracle's convolution, within 2 % of the maximum"
                    * technique("post.glow")) {
    LightImage picture = dot_at(160, 96, {50.5, 40.5}, 40);
    for (int y = 60; y < 80; ++y) {
        for (int x = 100; x < 150; ++x) {
            picture.pixels[y * 160 + x] = {2, 0.5, x % 7 == 0 ? 3 : 0};
        }
    }
    const Glow glow = {.strength = 1, .radius = 0.15f, .firefly = 0};
    const LightImage made = glowing(picture, glow);
    const std::vector<float> weights = glow_weights(glow, 160, 96);
    const LightImage exact = oracle::scatter(picture, 1, oracle::scattering_of_levels(weights));
    double peak = 0;
    double worst = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
        peak = std::max(peak, exact.pixels[i].x);
        worst = std::max(worst, std::abs(exact.pixels[i].x - made.pixels[i].x));
    }
    CHECK(worst < 0.02 * peak);
}

// ---- the emissive mask

TEST_CASE_FIXTURE(
    Scene, "glow: a mask without lamps is black, and the image is bit-identical"
               * technique("post.effect-pipeline, post.glow")) {
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    shine(PointLight{.intensity = 5}, at({0, 0, 1}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 40, 32);
    const gpu::FloatImage without = radiance(view);
    world.insert_resource(Glow{.kind = GlowKind::Mask, .strength = 1});
    CHECK(radiance(view).pixels == without.pixels);
    CHECK(frame_graph(shared_renderer()).was_run("glow mask"));
}

TEST_CASE_FIXTURE(
    Scene, "glow: a lamp behind a black wall adds nothing, with any light method"
               * technique("post.glow")) {
    place_objects(*this, {9, 4, 2}, -1);
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 40, 32);
    const gpu::FloatImage bare = radiance(view);
    for (const LightMethod method : {LightMethod::Clustered, LightMethod::ObjectMajor}) {
        world.insert_resource(Rendering{.lights = method});
        world.insert_resource(Glow{.kind = GlowKind::Mask, .strength = 1});
        CHECK(radiance(view).pixels != bare.pixels);
    }
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}}), at({0, 0, 0}));
    for (const glm::dvec3& pixel : picture_of(radiance(view)).pixels) {
        CHECK(pixel == glm::dvec3(0));
    }
}

TEST_CASE_FIXTURE(
    Scene, "glow: a mask adds the lamp's light once, and twice as much at twice the strength"
               * technique("post.glow")) {
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 80, 64);
    const auto added = [&](const Vec3& emission, float strength) {
        Scene scene;
        place_objects(scene, emission);
        const LightImage bare = picture_of(scene.radiance(view));
        scene.world.insert_resource(
            Glow{.kind = GlowKind::Mask, .strength = strength, .passes = 3});
        LightImage made = picture_of(scene.radiance(view));
        double lamp = 0;
        for (std::size_t i = 0; i < made.pixels.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                CHECK(made.pixels[i][c] >= bare.pixels[i][c]);
            }
            lamp += bare.pixels[i].y;
            made.pixels[i] -= bare.pixels[i];
        }
        CHECK(green_sum(made) == test::near(strength * lamp).epsilon(1e-3));
        return green_sum(made);
    };
    const double once = added({4, 2, 1}, 1);
    CHECK(added({8, 4, 2}, 1) == test::near(2 * once).epsilon(1e-4));
    CHECK(added({4, 2, 1}, 0.5f) == test::near(0.5 * once).epsilon(1e-4));
}

}  // namespace limn::test::glow_test
