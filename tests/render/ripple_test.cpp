#include "bench/oracles/ripple_oracle.h"
#include "ecs/components/ripple.h"
#include "ecs/components/time.h"
#include "render/graph/frame_graph.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::test::ripple_test {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kWidth = 96;
constexpr int kHeight = 64;

class Rippled : public Scene {
  public:
    Rippled() { world.insert_resource(FrameTime{.time = 1.25}); }

    /// A wall of many colors 8 m away, and off the center a post 2 m away.
    void place_objects(const Vec3& post_color) {
        ImageData image = {.name = "wall", .width = 16, .height = 16, .srgb = false, .pixels = {}};
        for (int i = 0; i < 256; ++i) {
            for (const int c : {i * 37 % 256, i * 91 % 256, i * 53 % 256, 255}) {
                image.pixels.push_back(static_cast<std::uint8_t>(c));
            }
        }
        const MeshId square = add(make_square());
        place(
            square,
            add(Material{
                .shading = ShadingModel::Unlit, .base_color_texture = {.image = add(image)}}),
            affine_from({0, 0, -8}, {1, 0, 0, 0}, Vec3(14)));
        place(
            square,
            add(Material{.shading = ShadingModel::Unlit, .base_color = Vec4(post_color, 1)}),
            affine_from({0.4f, 0, -2}, {1, 0, 0, 0}, {0.3f, 3, 1}));
    }
    [[nodiscard]] RenderView seen() const {
        return look({0, 0, 0}, {0.1f, 0.05f, -1}, kWidth, kHeight);
    }

    /// The shift of every pixel [px], rows from the top, and the distance of what it shows.
    struct Field {
        gpu::FloatImage shift;
        gpu::FloatImage depth;
    };
    Field field() {
        FrameGraph& graph = frame_graph(shared_renderer());
        graph.keep_named("ripple.field");
        const FrameOutput out = draw(seen(), {.aovs = {"depth"}});
        graph.forget_named("ripple.field");
        const gpu::Texture* texture = graph.texture(graph.find("ripple.field"));
        REQUIRE(texture != nullptr);
        return {gpu::read_floats(*texture), gpu::read_floats(*out.aovs[0].texture)};
    }
    /// Largest distance of the field to what `shift(pixel from below, distance)` says.
    template <typename Shift>
    double field_error(const Shift& shift, double* largest = nullptr) {
        const Field found = field();
        double worst = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const dvec2 exact =
                    shift(dvec2(x + 0.5, kHeight - y - 0.5), found.depth.at(x, y, 0));
                const dvec2 off = dvec2(found.shift.at(x, y, 0), found.shift.at(x, y, 1)) - exact;
                worst = std::max(worst, glm::length(off));
                if (largest != nullptr) {
                    *largest = std::max(*largest, glm::length(exact));
                }
            }
        }
        return worst;
    }
};

RippleRing ring_at(float age) {
    return {.age = age, .duration = 2, .speed = 2, .wavelength = 1.2f, .amplitude = 0.06f};
}

}  // namespace

// ---- the spec's formula

TEST_CASE(
    "ripple: the screen wave has the printed zeros, values and extrema"
    * technique("post.scene-ripple")) {
    const auto wave = [](double w0) { return oracle::screen_wave(1 - w0, 1, 1); };
    for (const double zero : {0.0, 0.2, 0.6, 1.0}) {
        CHECK(std::abs(wave(zero)) < 1e-9);
    }
    CHECK(oracle::screen_wave(3, 2, 1) == 0);
    CHECK(wave(0.1) == test::near(0.0707107).epsilon(1e-6));
    CHECK(wave(0.4) == test::near(-0.4).epsilon(1e-6));
    CHECK(wave(0.8) == test::near(0.8).epsilon(1e-6));
    double high = 0;
    double low = 0;
    for (int i = 0; i <= 100000; ++i) {
        high = std::max(high, wave(i * 1e-5));
        low = std::min(low, wave(i * 1e-5));
    }
    CHECK(high == test::near(0.809908).epsilon(1e-5));
    CHECK(high == test::near(wave(0.81962)).epsilon(1e-6));
    CHECK(low == test::near(-0.418688).epsilon(1e-5));
    CHECK(low == test::near(wave(0.43616)).epsilon(1e-6));
}

TEST_CASE(
    "ripple: the screen folds over itself exactly when amplitude / radius is 0.196074"
    * technique("post.scene-ripple")) {
    const auto folds = [](double amplitude) {
        double before = 0;
        for (int i = 1; i <= 100000; ++i) {
            const double d = i * 1e-5;
            const double position = d + oracle::screen_wave(d, 1, amplitude);
            if (position < before) {
                return true;
            }
            before = position;
        }
        return false;
    };
    CHECK(!folds(0.19606));
    CHECK(folds(0.19609));
}

// ---- the field

TEST_CASE_FIXTURE(
    Rippled, "ripple: the screen's field matches the formula, with the center at the lower left"
                 * technique("post.scene-ripple")) {
    place_objects({1, 0, 0});
    const ScreenRipple ripple = {
        .center = {0.3f, 0.4f}, .age = 0.2f, .duration = 0.5f, .amplitude = 0.05f, .radius = 0.1f};
    world.create(ripple);
    const double radius = ripple.radius + ripple.radius_speed * ripple.age;
    const double amplitude = ripple.amplitude * std::sin(kPi * 0.4);
    double largest = 0;
    const double off = field_error(
        [&](const dvec2& pixel, double) {
            const dvec2 size(kWidth, kHeight);
            return size * oracle::screen_shift(pixel / size, {0.3, 0.4}, radius, amplitude);
        },
        &largest);
    CHECK(off < 0.01);
    CHECK(largest > 2);
}

TEST_CASE_FIXTURE(
    Rippled,
    "ripple: a round one is round in pixels, and several add up" * technique("post.scene-ripple")) {
    place_objects({1, 0, 0});
    const ScreenRipple one = {
        .center = {0.5f, 0.5f}, .age = 0.25f, .radius = 0.3f, .radius_speed = 0, .round = true};
    const ScreenRipple two = {.center = {0.2f, 0.7f}, .age = 0.25f, .radius_speed = 1};
    const Entity first = world.create(one);
    const gpu::FloatImage alone = field().shift;
    for (int i = 1; i < 18; ++i) {  // a quarter turn around the center
        const float right = alone.at(kWidth / 2 + i, kHeight / 2, 0);
        const float up = alone.at(kWidth / 2, kHeight / 2 - 1 - i, 1);
        CHECK(right == test::near(up).epsilon(1e-3));
    }
    const Entity second = world.create(two);
    const gpu::FloatImage both = field().shift;
    world.destroy(first);
    const gpu::FloatImage other = field().shift;
    world.destroy(second);
    for (std::size_t i = 0; i < both.pixels.size(); i += 4) {
        CHECK(both.pixels[i] == test::near(alone.pixels[i] + other.pixels[i]).epsilon(1e-4));
    }
}

TEST_CASE_FIXTURE(
    Rippled, "ripple: evaluated at grid points it converges, 3 times closer for twice as many"
                 * technique("post.scene-ripple")) {
    const auto error_of = [&](int points) {
        const Entity e = world.create(ScreenRipple{
            .age = 0.25f, .amplitude = 0.05f, .radius = 0.9f, .radius_speed = 0, .grid = points});
        const double off = field_error([&](const dvec2& pixel, double) {
            const dvec2 size(kWidth, kHeight);
            return size * oracle::screen_shift(pixel / size, {0.5, 0.5}, 0.9, 0.05);
        });
        world.destroy(e);
        return off;
    };
    const double coarse = error_of(33);
    const double fine = error_of(65);
    CHECK(fine < coarse / 3);
    CHECK(error_of(0) < 0.01);
}

TEST_CASE_FIXTURE(
    Rippled, "ripple: a ring deflects rays as the oracle does, within a quarter of a pixel") {
    place_objects({1, 0, 0});
    const Vec3 center = {-0.3f, 0.2f, -4};
    world.create(ring_at(0.5f), WorldTransform{at(center)});
    const oracle::RingWave wave = {
        .center = dvec3(center), .radius = 1, .wavelength = 1.2, .amplitude = 0.06 * 0.75};
    const oracle::RippleCamera camera = oracle::ripple_camera(seen());
    double largest = 0;
    const double off = field_error(
        [&](const dvec2& pixel, double distance) {
            return oracle::ring_shift(camera, wave, pixel, distance);
        },
        &largest);
    CHECK(off < 0.01);
    CHECK(largest > 0.5);
}

TEST_CASE_FIXTURE(
    Rippled, "ripple: hot air shifts pixels as the oracle does, never by more than its strength"
                 * technique("post.glare-heat-haze")) {
    place_objects({1, 0, 0});
    for (const HazeShape shape : {HazeShape::Box, HazeShape::Ball}) {
        const Affine pose =
            affine_from({0.2f, 0, -4}, glm::normalize(Quat(1, 0.1f, 0.3f, 0)), {1.5f, 2, 1});
        const HeatHaze haze = {.shape = shape, .strength = 0.1f, .scale = 0.4f, .rise = 0.5f};
        const Entity e = world.create(haze, WorldTransform{pose});
        const oracle::HotAir air = {
            .local_from_world = glm::inverse(glm::dmat4(to_mat4(pose))),
            .ball = shape == HazeShape::Ball,
            .shift = 0.1 * kHeight,
            .scale = 0.4,
            .raised = 0.5 * 1.25 / 0.4,
            .seed = haze.seed};
        const oracle::RippleCamera camera = oracle::ripple_camera(seen());
        double largest = 0;
        const double off = field_error(
            [&](const dvec2& pixel, double distance) {
                return oracle::haze_shift(camera, air, pixel, distance);
            },
            &largest);
        CHECK(off < 0.25);
        CHECK(largest > 1);
        CHECK(largest < 0.1 * kHeight);
        world.destroy(e);
    }
}

// ---- the image

TEST_CASE_FIXTURE(
    Rippled, "ripple: with strength 0 or outside its duration there is no pass"
                 * technique("post.scene-ripple")) {
    place_objects({1, 0, 0});
    static_cast<void>(draw(seen()));
    const gpu::FloatImage still = radiance(seen());
    const Affine there = at({0, 0, -4});
    world.create(RippleRing{.age = 0.5f, .amplitude = 0}, WorldTransform{there});
    world.create(RippleRing{.age = -0.5f}, WorldTransform{there});
    world.create(RippleRing{.age = 5}, WorldTransform{there});
    world.create(RippleRing{.age = 0.1f}, WorldTransform{at({0, 0, 400})});  // behind the camera
    world.create(HeatHaze{.strength = 0}, WorldTransform{there});
    world.create(ScreenRipple{.age = 0.25f, .amplitude = 0});
    world.create(ScreenRipple{.age = 0.25f, .radius = -1, .radius_speed = 0});
    world.create(ScreenRipple{.age = 0.5f, .duration = 0.5f});
    world.insert_resource(LensRain{.amount = 0});
    CHECK(radiance(seen()).pixels == still.pixels);
    CHECK(!frame_graph(shared_renderer()).was_run("ripple"));
    // A pass that shifts no visible pixel is bit-identical, too.
    world.create(ring_at(0.1f), WorldTransform{at({0, 0, -30})});
    CHECK(radiance(seen()).pixels == still.pixels);
    CHECK(frame_graph(shared_renderer()).was_run("ripple"));
}

TEST_CASE(
    "ripple: the foreground neither ripples nor leaks, bit-exactly"
    * technique("post.glare-heat-haze, post.scene-ripple")) {
    const auto pictures = [](const Vec3& post) {
        std::vector<gpu::FloatImage> made;
        for (int kind = 0; kind < 3; ++kind) {
            Rippled scene;
            scene.place_objects(post);
            if (kind == 1) {
                scene.world.create(
                    RippleRing{
                        .age = 0.3f,
                        .duration = 2,
                        .speed = 3,
                        .wavelength = 1.5f,
                        .amplitude = 0.4f},
                    WorldTransform{at({0.3f, 0, -4})});
            }
            if (kind == 2) {
                scene.world.create(
                    HeatHaze{.strength = 0.2f, .scale = 0.3f},
                    WorldTransform{affine_from({0.5f, 0, -4}, {1, 0, 0, 0}, {2, 3, 1})});
            }
            made.push_back(scene.radiance(scene.seen()));
            made.push_back(scene.aov(scene.seen(), "depth"));
        }
        return made;
    };
    const std::vector<gpu::FloatImage> red = pictures({50, 0, 0});
    const std::vector<gpu::FloatImage> green = pictures({0, 50, 0});
    const gpu::FloatImage& depth = red[1];
    for (const std::size_t kind : {2u, 4u}) {
        int rippled = 0;
        int front = 0;
        int leaked = 0;
        int moved_front = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const bool is_front = depth.at(x, y, 0) < 3;
                front += is_front ? 1 : 0;
                rippled += rgb_at(red[kind], x, y) != rgb_at(red[0], x, y) ? 1 : 0;
                leaked += !is_front && rgb_at(red[kind], x, y) != rgb_at(green[kind], x, y) ? 1 : 0;
                moved_front += is_front && rgb_at(red[kind], x, y) != rgb_at(red[0], x, y) ? 1 : 0;
            }
        }
        CAPTURE(kind);
        CHECK(front > 200);
        CHECK(rippled > 400);
        CHECK(leaked == 0);
        CHECK(moved_front == 0);
    }
}

TEST_CASE_FIXTURE(
    Rippled,
    "ripple: positions outside the image sample its edge" * technique("post.scene-ripple")) {
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0.25f, 0.5f, 1, 1}}),
        affine_from({0, 0, -8}, {1, 0, 0, 0}, Vec3(40)));
    world.create(ScreenRipple{
        .center = {0, 1}, .age = 0.25f, .amplitude = 0.9f, .radius = 2, .radius_speed = 0});
    const gpu::FloatImage made = radiance(seen());
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            CHECK(made.at(x, y, 1) == test::near(0.5f).epsilon(1e-3));
        }
    }
}

TEST_CASE_FIXTURE(Rippled, "ripple: rain is a function of time and seed") {
    place_objects({1, 0, 0});
    const auto rained = [&](double time, std::uint32_t seed) {
        world.insert_resource(FrameTime{.time = time});
        world.insert_resource(LensRain{.amount = 0.8f, .size = 0.2f, .seed = seed});
        return radiance(seen());
    };
    const gpu::FloatImage first = rained(2, 1);
    CHECK(rained(2.5, 1).pixels != first.pixels);
    CHECK(rained(2, 2).pixels != first.pixels);
    CHECK(rained(2, 1).pixels == first.pixels);
    for (const float value : first.pixels) {
        CHECK(std::isfinite(value));
    }
}

}  // namespace limn::test::ripple_test
