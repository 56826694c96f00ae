#include "ecs/base/optics.h"
#include "ecs/components/caustics.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "render/graph/frame_graph.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>

namespace limn::test::caustics_maps_test {
namespace {

constexpr float kDepth = 10;  ///< of the sea [m]
constexpr int kSize = 64;     ///< of an image [pixels]

/// Water over an even floor, the sun straight above.
class Floor : public Scene {
  public:
    Floor() {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 1});
        world.insert_resource(Exposure{});
        const MaterialId white = add(Material{
            .shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = Vec3(0)});
        place(
            add(make_square()), white,
            affine_from({0, -kDepth, 0}, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), Vec3(300)));
        shine(
            DirectionalLight{.color = {1, 1, 1}, .illuminance = 1},
            look_at({1e-4f, 1, 0}, {0, 0, 0}));
    }
    Entity fill(const Water& water, const Vec3& position, const Caustics& caustics) {
        return world.create(water, WorldTransform{at(position)}, caustics);
    }
    Entity sea(const Caustics& caustics) {
        const Entity water = fill(
            {.size = {0, 0}, .depth = kDepth, .absorption = Vec3(1e-5f), .scattering = Vec3(0)},
            {0, 0, 0}, caustics);
        WaveTable table;
        fill_wave_table(
            world.get<Water>(water),
            {.waves =
                 {{.amplitude = 0.03f, .length = 4.2f, .direction = 0.3f},
                  {.amplitude = 0.02f, .length = 5.7f, .direction = 1.9f, .phase = 1}}},
            1.0, table);
        world.add(water, table);
        return water;
    }
    /// Straight down.
    [[nodiscard]] RenderView from(const Vec3& eye, float fov = 120) const {
        const Affine pose =
            affine_from(eye, glm::angleAxis(radians(-90), Vec3(1, 0, 0)), {1, 1, 1});
        return make_render_view(
            {.fov_y = radians(fov), .near = 0.01f}, pose, pose, {.width = kSize, .height = kSize});
    }
    gpu::FloatImage map() {
        FrameGraph& graph = frame_graph(shared_renderer());
        const gpu::Texture* const texture = graph.texture(graph.find("caustics"));
        REQUIRE(texture != nullptr);
        return gpu::read_floats(*texture);
    }
};

/// Mean difference over the mean of `exact`.
float relative_difference(const gpu::FloatImage& found, const gpu::FloatImage& exact) {
    float difference = 0;
    float sum = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            difference += std::abs(found.at(x, y, 0) - exact.at(x, y, 0));
            sum += exact.at(x, y, 0);
        }
    }
    return difference / sum;
}

}  // namespace

TEST_CASE_FIXTURE(
    Floor, "caustics: cascades match one large map far from the camera, without a seam"
               * technique("caustic.projected-vertices")) {
    const Entity water = sea({.resolution = 1024, .spacing = 1, .window = 128});
    // Sixteen meters to each side: the finest window ends at four, the next at sixteen.
    const RenderView view = from({0, -0.5f, 0});
    const gpu::FloatImage exact = radiance(view);
    world.get<Caustics>(water) = {.resolution = 256, .spacing = 1, .window = 8, .cascades = 3};
    CHECK(relative_difference(radiance(view), exact) < 0.02f);
    world.get<Caustics>(water).cascades = 1;
    CHECK(relative_difference(radiance(view), exact) > 0.05f);
}

TEST_CASE_FIXTURE(
    Floor, "caustics: cascades do not swim, they move in whole texels"
               * technique("caustic.projected-vertices")) {
    sea({.resolution = 64, .spacing = 2, .window = 8, .cascades = 2});
    draw(from({0.01f, -0.5f, 0.01f}));
    const gpu::FloatImage here = map();
    draw(from({0.99f, -0.5f, 0.01f}));
    CHECK(largest_difference(here, map()) == 0);
    // A meter is eight texels of the finest, which has 64 to eight meters; the next stays.
    draw(from({1.01f, -0.5f, 0.01f}));
    const gpu::FloatImage there = map();
    float most = 0;
    for (int z = 20; z < 44; ++z) {
        for (int x = 20; x < 44; ++x) {
            most = std::max(most, std::abs(there.at(x, z, 0) - here.at(x + 8, z, 0)));
        }
        for (int x = 64; x < 128; ++x) {
            CHECK(there.at(x, z, 0) == here.at(x, z, 0));
        }
    }
    CHECK(most < 1e-3f);
}

TEST_CASE_FIXTURE(
    Floor, "caustics: a hundred pools take as many passes as one, and each has caustics"
               * technique("caustic.projected-vertices")) {
    const float red = 0.2f;
    const auto fill_pool = [&](int i) {
        return fill(
            {.size = {4, 4}, .depth = kDepth, .absorption = {red, 0, 0}, .scattering = Vec3(0)},
            {static_cast<float>(6 * (i % 10)), 0, static_cast<float>(6 * (i / 10))},
            {.resolution = 256 << (i % 3)});  // far more than all may have
    };
    fill_pool(0);
    draw(from({0, -0.1f, 0}));
    draw(from({0, -0.1f, 0}));  // what is done once is done
    FrameGraph& graph = frame_graph(shared_renderer());
    const int passes = graph.stats().passes_run;
    CHECK(graph.was_run("caustic rays"));
    for (int i = 1; i < 100; ++i) {
        fill_pool(i);
    }
    draw(from({0, -0.1f, 0}));
    draw(from({0, -0.1f, 0}));
    CHECK(graph.stats().passes_run == passes);
    const gpu::FloatImage atlas = map();
    CHECK(atlas.width * atlas.height <= 2 << 20);
    const float flat = (1 - fresnel(1, 1.333f)) / kPi;
    for (const int i : {0, 7, 55, 99}) {
        CAPTURE(i);
        const Vec3 center(
            static_cast<float>(6 * (i % 10)), -kDepth + 0.5f, static_cast<float>(6 * (i / 10)));
        const gpu::FloatImage image = radiance(from(center, 20));
        CHECK(image.at(32, 32, 1) / (flat) == test::near(1).epsilon(0.01));
        const float left = std::exp(-red * (kDepth + 0.5f));  // down, and half a meter to the lens
        CHECK(image.at(32, 32, 0) / (flat * left) == test::near(1).epsilon(0.02));
        const gpu::FloatImage dry = radiance(from(center + Vec3(3, 0, 0), 20));
        CHECK(dry.at(32, 32, 0) / (1 / kPi) == test::near(1).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(Floor, "caustics: a pool out of view has no map") {
    const Entity pool = fill({.size = {4, 4}, .depth = 2}, {0, 0, 0}, {.resolution = 64});
    FrameGraph& graph = frame_graph(shared_renderer());
    const auto is_made = [&](const Vec3& eye, const Vec3& target) {
        const Affine pose = look_at(eye, target);
        draw(make_render_view(
            {.fov_y = radians(40.0f), .near = 0.01f}, pose, pose,
            {.width = kSize, .height = kSize}));
        return graph.was_run("caustic rays");
    };
    CHECK(is_made({6, 1, 0}, {0, 0, 0}));
    CHECK(!is_made({6, 1, 0}, {12, 0, 0}));
    CHECK(!is_made({6, 1, 0}, {6, 0, 9}));
    CHECK(is_made({6, 1, 0}, {2.5f, 0, 3}));     // its corner
    world.get<Caustics>(pool).mirror_reach = 1;  // what it lights may be anywhere
    CHECK(is_made({6, 1, 0}, {12, 0, 0}));
}

}  // namespace limn::test::caustics_maps_test
