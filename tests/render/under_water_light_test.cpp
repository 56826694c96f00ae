#include "ecs/base/optics.h"
#include "ecs/components/caustics.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::test::under_water_light_test {
namespace {

constexpr float kDepth = 4;  ///< [m]
constexpr int kSize = 48;    ///< of an image [pixels]

/// A wide pool, its floor far away from what is looked at.
class Pool : public Scene {
  public:
    Pool() {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 1});
        world.insert_resource(Exposure{});
        white_ = add(Material{.shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}});
        lay({0, -kDepth, 0}, 12, -90);
        water_ = world.create(
            Water{
                .size = {20, 20},
                .depth = kDepth,
                .absorption = Vec3(0.05f),
                .scattering = Vec3(0.1f)},
            WorldTransform{at({0, 0, 0})}, Caustics{.resolution = 256, .spacing = 1});
    }
    Entity lay(const Vec3& center, float half, float turn) {
        return place(
            add(make_square()), white_,
            affine_from(center, glm::angleAxis(radians(turn), Vec3(1, 0, 0)), Vec3(half)));
    }
    void wave() {
        WaveTable table;
        fill_wave_table(
            world.get<Water>(water_),
            {.waves =
                 {{.amplitude = 0.02f, .length = 1.3f, .direction = 0.3f},
                  {.amplitude = 0.015f, .length = 0.9f, .direction = 1.9f, .phase = 1}}},
            1.0, table);
        world.add(water_, table);
    }
    Entity sun(const Vec3& to_sun) {
        return shine(
            DirectionalLight{.color = {1, 1, 1}, .illuminance = 1}, look_at(to_sun, {0, 0, 0}));
    }
    Caustics& caustics() { return world.get<Caustics>(water_); }
    /// Level, through the water.
    [[nodiscard]] RenderView level(const Vec3& eye = {0, -2, 0}) const {
        const Affine pose = look_at(eye, eye + Vec3(0, 0, -1));
        return make_render_view(
            {.fov_y = radians(30.0f), .near = 0.01f}, pose, pose,
            {.width = kSize, .height = kSize});
    }

    Entity water_;

  private:
    MaterialId white_;
};

double mean(const gpu::FloatImage& image) {
    double sum = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            sum += static_cast<double>(image.at(x, y, 1));
        }
    }
    return sum / (kSize * kSize);
}

double deviation(const gpu::FloatImage& image) {
    const double center = mean(image);
    double sum = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            sum += std::pow(static_cast<double>(image.at(x, y, 1)) / center - 1, 2);
        }
    }
    return std::sqrt(sum / (kSize * kSize));
}

}  // namespace

TEST_CASE_FIXTURE(Pool, "water shafts: flat water has none, and 0 steps change nothing") {
    sun(glm::normalize(Vec3(0.3f, 1, 0.2f)));
    const gpu::FloatImage even = radiance(level());
    caustics().shaft_steps = 8;
    CHECK(largest_difference(even, radiance(level())) < 0.002f * static_cast<float>(mean(even)));
    wave();
    const gpu::FloatImage shafts = radiance(level());
    caustics().shaft_steps = 0;
    const gpu::FloatImage none = radiance(level());
    CHECK(largest_difference(none, shafts) > 0.02f * static_cast<float>(mean(none)));
}

TEST_CASE_FIXTURE(
    Pool, "water shafts: in-scattered light varies with the waves, with a constant mean"
              * technique("caustic.projected-vertices")) {
    sun(glm::normalize(Vec3(0.1f, 1, -1.5f)));
    wave();
    double with = 0;
    double without = 0;
    double contrast = 0;
    // Level rays end at the wall of the image, eight meters away: nothing but the veil changes.
    lay({0, -2, -8}, 6, 0);
    for (const float x : {-4.0f, -1.5f, 0.0f, 2.0f, 4.5f}) {
        const RenderView view = level({x, -2, 4});
        caustics().shaft_steps = 16;
        const gpu::FloatImage shafts = radiance(view);
        caustics().shaft_steps = 0;
        const gpu::FloatImage even = radiance(view);
        with += mean(shafts);
        without += mean(even);
        contrast += deviation(shafts) - deviation(even);
    }
    CHECK(with / without == test::near(1).epsilon(0.01));
    CHECK(contrast / 5 > 0.01);
}

TEST_CASE_FIXTURE(
    Pool, "water shafts: an object in the water casts a dark shaft"
              * technique("caustic.projected-vertices")) {
    sun({0, 1, 0});
    caustics().shaft_steps = 16;
    const RenderView view = level({0, -2, 4});
    const float open = radiance(view).at(kSize / 2, kSize / 2, 1);
    lay({0, -1, 2.5f}, 1, -90);
    const float dark = radiance(view).at(kSize / 2, kSize / 2, 1);
    caustics().shaft_steps = 0;
    const float before = radiance(view).at(kSize / 2, kSize / 2, 1);
    CHECK(dark < 0.9f * open);
    CHECK(before / open == test::near(1).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    Pool, "under water: light of lamps is absorbed along its path, and reflected at the surface"
              * technique("caustic.projected-vertices")) {
    const float extinction = 0.15f;
    const Vec3 eye(0, -kDepth + 0.5f, 0);
    const Affine pose = affine_from(eye, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), {1, 1, 1});
    const RenderView view = make_render_view(
        {.fov_y = radians(20.0f), .near = 0.01f}, pose, pose, {.width = kSize, .height = kSize});
    const auto floor_below = [&] { return radiance(view).at(kSize / 2, kSize / 2, 1); };
    const float veil = std::exp(-extinction * 0.5f);
    for (const Vec2 heights_and_index : {Vec2(1, 1.333f), Vec2(-2, 1.333f), Vec2(1, 1.8f)}) {
        const float height = heights_and_index.x;
        const float index = heights_and_index.y;
        CAPTURE(height);
        CAPTURE(index);
        world.get<Water>(water_).refractive_index = index;
        const Entity lamp = shine(PointLight{.radius = 0}, at({0, height, 0}));
        const float wet = floor_below();
        world.get<WorldTransform>(water_).world = at({100, 0, 0});
        const float bare = floor_below();
        world.get<WorldTransform>(water_).world = at({0, 0, 0});
        const float let_in = height > 0 ? 1 - fresnel(1, index) : 1;
        const float path = height > 0 ? kDepth : kDepth + height;
        CHECK(
            wet / (bare * let_in * std::exp(-extinction * path) * veil)
            == test::near(1).epsilon(0.002));
        world.destroy(lamp);
    }
}

}  // namespace limn::test::under_water_light_test
