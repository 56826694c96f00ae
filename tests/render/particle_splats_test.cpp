// Points on the GPU that only add light, drawn by compute: sums of discs, as the rasterizer has
// them.

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/weather.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/particles/particle_list.h"
#include "render/particles/particle_splats.h"
#include "systems/particles/gpu_particle_system.h"
#include "systems/particles/particle_obstacles.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace limn::test::particle_splats_test {
namespace {

constexpr int kSide = 33;               // of the image [px]
constexpr float kPixel = 2.0f / kSide;  // extent a meter before the camera [m]

/// Points that are born at once and stay where they are.
struct Points : Scene {
    Points() {
        world.insert_resource(FrameTime{});
        world.insert_resource(RandomSeed{});
        world.insert_resource(WeatherState{});
        world.insert_resource(ParticleObstacles{});
        world.insert_resource(GpuShapes{});
    }
    static ParticleLook look_of(float pixels, const Vec3& color) {
        ParticleLook look;
        look.facing = ParticleFacing::Point;
        look.size = pixels * kPixel;
        look.softness = 0;
        look.emission = 1;
        look.lit = 0;
        look.cover = 0;
        look.colors = {{.at = 0, .color = color}};
        return look;
    }
    /// `extent`: half of the box that they are born in [m].
    Entity emit(
        const ParticleLook& look, std::uint32_t count = 1, const Vec3& position = {0, 0, 0},
        const Vec3& extent = {0, 0, 0}) {
        ParticleEmitter emitter;
        emitter.executor = ParticleExecutor::Gpu;
        emitter.rate = 0;
        emitter.bursts = {{.time = 0, .count = static_cast<float>(count)}};
        emitter.capacity = count;
        emitter.shape = EmitterShape::Box;
        emitter.size = extent;
        emitter.speed = emitter.speed_spread = 0;
        emitter.life = 1000;
        emitter.life_spread = 0;
        emitter.seed = 3;
        ParticleMotion motion;
        motion.gravity = 0;
        return world.create(
            emitter, motion, look, WorldTransform{at(position)},
            PreviousWorldTransform{at(position)});
    }
    void bear() {
        world.run(add_gpu_particles);
        for (int i = 0; i < 2; ++i) {
            FrameTime& time = world.resource<FrameTime>();
            time.time += static_cast<double>(time.step);
            ++time.frame;
            world.run(find_particle_obstacles);
            world.run(record_gpu_particles);
        }
    }
    /// From a meter away.
    gpu::FloatImage draw_view() {
        bear();
        return radiance(look({0, 0, 1}, {0, 0, 0}, kSide, kSide));
    }
};

/// What a GPU's half floats round [fraction of the light], or the integers.
float rounding(const Points& scene) {
    return scene.device().caps().profile == gpu::Profile::Gpu ? 1e-3f : 2e-5f;
}

double sum_of_red(const gpu::FloatImage& image) {
    double sum = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            sum += static_cast<double>(image.at(x, y, 0));
        }
    }
    return sum;
}

/// So little that it changes nothing, but is for the rasterizer.
ParticleLook rasterized(ParticleLook look) {
    look.softness = 1e-6f;
    return look;
}

}  // namespace

TEST_CASE(
    "particle splats: a point is a disc of (1 - r^2)^2 of its light, of any size"
    * technique("particle.gpu-draw")) {
    for (const float pixels : {0.5f, 1.0f, 3.0f, 7.9f, 8.1f, 21.0f}) {
        CAPTURE(pixels);
        Points scene;
        const Vec3 color = {2, 0.5f, 0.25f};
        const float aside = 0.3f;  // [px]
        scene.emit(Points::look_of(pixels, color), 1, {aside * kPixel, 0, 0});
        const gpu::FloatImage image = scene.draw_view();
        const float radius = 0.5f * std::max(pixels, 2.0f);
        const float faint = std::min(0.25f * pixels * pixels, 1.0f);  // instead of smaller
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const Vec2 from = Vec2(x - kSide / 2, y - kSide / 2) - Vec2(aside, 0);
                const float inside = std::max(1 - glm::dot(from, from) / (radius * radius), 0.0f);
                const Vec3 wanted = faint * inside * inside * color;
                CHECK(
                    glm::length(rgb_at(image, x, y) - wanted)
                    < 2 * rounding(scene) + 1e-3f * faint);
            }
        }
    }
}

TEST_CASE(
    "particle splats: the image is that of rasterized points" * technique("particle.gpu-draw")) {
    const auto drawn = [](bool rasterize) {
        Points scene;
        ParticleLook dots = Points::look_of(1.7f, {0.2f, 0.3f, 0.4f});
        dots.size_spread = 0.5f * dots.size;
        dots.color_spread = {0.1f, 0.2f, 0.05f};
        ParticleLook sprites = Points::look_of(1, {0.3f, 0.1f, 0.02f});
        sprites.facing = ParticleFacing::Pixels;
        sprites.size = 5;
        sprites.attenuation = {1, 0, 0.3f};
        sprites.near_fade = 1.2f;
        for (const ParticleLook& look : {dots, sprites}) {
            scene.emit(rasterize ? rasterized(look) : look, 700, {0, 0, -0.4f}, {1, 1, 1});
        }
        return scene.draw_view();
    };
    const gpu::FloatImage splats = drawn(false);
    CHECK(sum_of_red(splats) > 30);
    // Which places them to 1/256 of a pixel: a disc of one changes by .006 of its light. Hardware
    // may have diameters in steps of 1/8 of a pixel.
    const float bound = Points::device().caps().software ? 0.004f : 0.05f;
    CHECK(largest_difference(splats, drawn(true)) < bound);
}

TEST_CASE("particle splats: a small point is as bright wherever it is among the pixels") {
    for (const bool rasterize : {false, true}) {
        for (const float pixels : {0.4f, 1.0f, 1.6f}) {
            const float mean = kPi / 3 * square(0.5f * pixels);  // of a disc of (1 - r^2)^2
            for (const Vec2 aside :
                 {Vec2(0, 0), Vec2(0.25f, 0.1f), Vec2(0.5f, 0), Vec2(0.5f, 0.5f)}) {
                CAPTURE(pixels);
                Points scene;
                const ParticleLook look = Points::look_of(pixels, {8, 1, 1});
                scene.emit(rasterize ? rasterized(look) : look, 1, Vec3(aside * kPixel, 0));
                const auto sum = static_cast<float>(sum_of_red(scene.draw_view()));
                CHECK(std::abs(sum - 8 * mean) < 0.09f * 8 * mean);
            }
        }
    }
}

TEST_CASE("particle splats: dust on the CPU covers them") {
    const auto light = [](float opacity) {
        Points scene;
        scene.emit(Points::look_of(5, {1, 1, 1}));
        ParticleLook dust = Points::look_of(400, {0, 0, 0});
        dust.facing = ParticleFacing::Camera;
        dust.cover = 1;
        dust.colors[0].opacity = opacity;
        ParticlePool pool;
        pool.x = pool.y = pool.z = pool.vx = pool.vy = pool.vz = pool.age = {0};
        pool.life = {1000};
        pool.look = {0};
        pool.stuck = {};
        scene.world.create(ParticleEmitter{}, dust, pool, WorldTransform{});
        return sum_of_red(scene.draw_view());
    };
    CHECK(light(0.5f) == near(0.5 * light(0)).epsilon(0.01));
}

TEST_CASE("particle splats: a steady look gives the image of one that might change") {
    const auto drawn = [](float fade) {
        Points scene;
        ParticleLook dots = Points::look_of(1.7f, {0.2f, 0.3f, 0.4f});
        dots.size_spread = 0.5f * dots.size;
        dots.fade = fade;  // over the last seconds of a life of a thousand
        CHECK(is_steady(make_look_record(dots, {})) == (fade == 0));
        scene.emit(dots, 700, {0, 0, -0.4f}, {1, 1, 1});
        return scene.draw_view();
    };
    CHECK(largest_difference(drawn(0), drawn(1)) < 1e-5f);
}

TEST_CASE("particle splats: a look that changes by age, life, distance or chance is not steady") {
    const auto steady = [](auto&& change) {
        ParticleLook look = Points::look_of(3, {1, 1, 1});
        change(look);
        return is_steady(make_look_record(look, {}));
    };
    CHECK(steady([](ParticleLook& look) { look.size_spread = 0.1f; }));
    CHECK_FALSE(steady([](ParticleLook& look) { look.facing = ParticleFacing::Pixels; }));
    CHECK_FALSE(steady([](ParticleLook& look) { look.size_curve = {{0, 1}, {1, 2}}; }));
    CHECK_FALSE(steady([](ParticleLook& look) {
        look.colors.push_back({.at = 1, .color = {1, 1, 1}, .opacity = 0});
    }));
    CHECK_FALSE(steady([](ParticleLook& look) { look.color_spread = {0, 0.1f, 0}; }));
    CHECK_FALSE(steady([](ParticleLook& look) { look.color_function.amplitude = 0.3f; }));
    CHECK_FALSE(steady([](ParticleLook& look) { look.near_fade = 2; }));
    CHECK_FALSE(steady([](ParticleLook& look) { look.far_fade = 2; }));
    CHECK_FALSE(steady([](ParticleLook& look) { look.fade = 2; }));
}

TEST_CASE("particle splats: what is behind something opaque adds nothing, what is before it all") {
    for (const float pixels : {1.0f, 9.0f}) {  // tested once, and pixel by pixel
        for (const float z : {-0.5f, 0.2f}) {
            Points scene;
            scene.place(
                scene.add(make_square()), scene.add(Material{}),
                affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(3)));
            scene.emit(Points::look_of(pixels, {1, 1, 1}), 1, {0, 0, z});
            const double light = sum_of_red(scene.draw_view());
            CAPTURE(pixels);
            CAPTURE(light);
            CHECK((z < 0 ? light == 0 : light > 0.3));
        }
    }
}

TEST_CASE("particle splats: many faint ones count in full beside a bright one") {
    const auto sum = [](bool beside) {
        Points scene;
        scene.emit(Points::look_of(2, Vec3(1e-6f)), 20000, {0, 0, 0}, {0.2f, 0.2f, 0});
        if (beside) {
            scene.emit(Points::look_of(2, {0, 0, 1}), 1, {0.9f, 0, 0});
        }
        return sum_of_red(scene.draw_view());
    };
    CHECK(sum(true) / sum(false) == near(1).epsilon(0.03));
}

TEST_CASE("particle splats: a hundred thousand at one pixel are as bright as their sum") {
    Points scene;
    scene.emit(Points::look_of(3, {0.5f, 0.25f, 0.125f}), 100000);
    const Vec3 found = rgb_at(scene.draw_view(), kSide / 2, kSide / 2);
    CHECK(found.x == near(50000).epsilon(0.001));
    CHECK(found.y == near(25000).epsilon(0.001));
    CHECK(found.z == near(12500).epsilon(0.001));
}

TEST_CASE("particle splats: the next frame begins without light") {
    Points scene;
    scene.emit(Points::look_of(3, {1, 1, 1}), 50, {0, 0, 0}, {0.5f, 0.5f, 0});
    const gpu::FloatImage first = scene.draw_view();
    CHECK(largest_difference(first, scene.draw_view()) == 0);
}

TEST_CASE("particle splats: glass before them dims them, and glass behind them does not") {
    for (const float z : {-0.3f, 0.3f}) {
        const auto light = [&](bool rasterize) {
            Points scene;
            Material glass;
            glass.alpha_mode = AlphaMode::Blend;
            glass.base_color = {0, 0, 0, 0.5f};
            scene.place(scene.add(make_square()), scene.add(glass), at({0, 0, z}));
            const ParticleLook look = Points::look_of(5, {1, 1, 1});
            scene.emit(rasterize ? rasterized(look) : look);
            return sum_of_red(scene.draw_view());
        };
        CHECK(light(false) == near(light(true)).epsilon(0.001));
        CHECK((z > 0 ? light(false) < 5 : light(false) > 5));
    }
}

TEST_CASE("particle splats: only points that add light, and neither hide nor fade nor are lit") {
    GpuParticlePool pool;
    const ParticleLook look = Points::look_of(1, {1, 1, 1});
    const auto can = [&](const ParticleLook& changed) {
        return can_be_splats(pool, make_look_record(changed, {}));
    };
    CHECK(can(look));
    CHECK_FALSE(can(rasterized(look)));
    for (float ParticleLook::*field : {&ParticleLook::lit, &ParticleLook::cover}) {
        ParticleLook changed = look;
        changed.*field = 0.5f;
        CHECK_FALSE(can(changed));
    }
    ParticleLook quad = look;
    quad.facing = ParticleFacing::Ground;
    CHECK_FALSE(can(quad));
    pool.sorted = true;
    CHECK_FALSE(can(look));
}

TEST_CASE("particle splats: the brightest is that of colors, their spread and emission") {
    ParticleLook look = Points::look_of(1, {0.5f, 0.25f, 1});
    look.emission = 3;
    look.color_spread = {1, 0, 0.25f};
    CHECK(max_light(make_look_record(look, {})) == near(3 * 1.5f));
    look.emission = std::numeric_limits<float>::infinity();
    CHECK(max_light(make_look_record(look, {})) == 0);
}

}  // namespace limn::test::particle_splats_test
