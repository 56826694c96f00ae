// Surfaces that are small in the image lose their normal maps and relief (Rendering::plain_below).

#include "ecs/components/rendering.h"
#include "render/material/detail_limit.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace limn::test::plain_below_test {
namespace {

struct BumpyScene : Scene {
    ImageId bumps;
    MeshId ball;

    BumpyScene() {
        std::mt19937 random(3);
        ImageData image;
        image.name = "bumps";
        image.width = image.height = 64;
        for (int i = 0; i < 64 * 64; ++i) {
            for (const int channel : {128, 128, 255, 255}) {
                const int shift = channel == 128 ? static_cast<int>(random() % 160) - 80 : 0;
                image.pixels.push_back(static_cast<std::uint8_t>(channel + shift));
            }
        }
        bumps = add(std::move(image));
        ball = add(make_ball(32));
        world.create(
            DirectionalLight{.illuminance = 3}, WorldTransform{look_at({1, 1, 2}, {0, 0, 0})});
    }
    /// With tangents along the meridians.
    MaterialId stone(bool bumpy) {
        Material material = {.base_color = {0.8f, 0.8f, 0.8f, 1}, .roughness = 0.6f};
        if (bumpy) {
            material.normal_texture.image = bumps;
        }
        return add(material);
    }
    /// Balls `distance` away, those of a list beside each other.
    gpu::FloatImage draw_balls(
        const std::vector<float>& distances, bool bumpy, float plain_below, int* draws = nullptr) {
        world.clear();
        world.insert_resource(Rendering{.plain_below = plain_below});
        world.create(
            DirectionalLight{.illuminance = 3}, WorldTransform{look_at({1, 1, 2}, {0, 0, 0})});
        const MaterialId material = stone(bumpy);
        float x = -1.5f * static_cast<float>(distances.size() - 1);
        for (const float distance : distances) {
            place(ball, material, at({x, 0, -distance}));
            x += 3;
        }
        const FrameOutput frame = draw(look({0, 0, 0}, {0, 0, -1}, 160, 120));
        if (draws != nullptr) {
            *draws = frame.statistics.draws;
        }
        return gpu::read_floats(*frame.radiance);
    }
};

double root_mean_square(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
        if (b.pixels[i] > 0) {
            const double d = static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i]);
            sum += d * d;
            ++covered;
        }
    }
    REQUIRE(covered > 20);
    return std::sqrt(sum / static_cast<double>(covered));
}

}  // namespace

TEST_CASE_FIXTURE(
    BumpyScene, "plain below: a surface has all of its detail or none, by its size alone"
                    * technique("engine.lod-shader")) {
    // The box of a ball is 2 sqrt(3) in diameter; at `look` 120 rows are 2 units at a distance
    // of 1.
    const auto size_at = [](float distance) { return 60 * 2 * std::sqrt(3.0f) / distance; };
    bool was_plain = false;
    int switches = 0;
    for (const float distance : {4.0f, 6.0f, 9.0f, 13.0f, 20.0f, 40.0f}) {
        CAPTURE(distance);
        const gpu::FloatImage bumpy = draw_balls({distance}, true, 0);
        const gpu::FloatImage plain = draw_balls({distance}, false, 0);
        REQUIRE(largest_difference(bumpy, plain) > 0);
        const gpu::FloatImage drawn = draw_balls({distance}, true, 20);
        const bool is_plain = size_at(distance) < 20;
        CHECK(largest_difference(drawn, is_plain ? plain : bumpy) == 0);
        switches += is_plain != was_plain ? 1 : 0;
        was_plain = is_plain;
    }
    CHECK(switches == 1);
}

TEST_CASE_FIXTURE(
    BumpyScene, "plain below: instances of one mesh and material are two batches at most"
                    * technique("engine.lod-shader")) {
    int all = 0;
    int some = 0;
    const std::vector<float> distances = {40, 5, 40, 5, 40};
    const gpu::FloatImage bumpy = draw_balls(distances, true, 0, &all);
    const gpu::FloatImage mixed = draw_balls(distances, true, 20, &some);
    CHECK(some == all + 1);
    CHECK(largest_difference(mixed, bumpy) > 0);
    const gpu::FloatImage plain = draw_balls(distances, false, 0);
    for (std::size_t i = 0; i < mixed.pixels.size(); ++i) {
        CHECK((mixed.pixels[i] == bumpy.pixels[i] || mixed.pixels[i] == plain.pixels[i]));
    }
}

TEST_CASE_FIXTURE(
    BumpyScene, "plain below: where a surface loses its detail it changes by less than 4 percent"
                    * technique("engine.lod-shader")) {
    // 8 pixels across, of 120 rows.
    const float distance = 60 * 2 * std::sqrt(3.0f) / 12;
    const gpu::FloatImage bumpy = draw_balls({distance}, true, 0);
    const gpu::FloatImage plain = draw_balls({distance}, true, 13);
    CHECK(root_mean_square(plain, bumpy) > 0);
    CHECK(root_mean_square(plain, bumpy) < 0.04);
    CHECK(root_mean_square(draw_balls({3}, true, 1000), draw_balls({3}, true, 0)) > 0.1);  // near
}

TEST_CASE_FIXTURE(
    BumpyScene, "plain below: a warm-up compiles what both need" * technique("engine.lod-shader")) {
    world.insert_resource(Rendering{.plain_below = 20});
    place(ball, stone(true), at({0, 0, 0}));
    RendererPtr renderer = *create_renderer(device());
    const auto view_from = [&](float distance) {
        return look({0, 0, distance}, {0, 0, 0}, 160, 120);
    };
    warm_up(*renderer, world, view_from(30));
    for (const float distance : {4.0f, 40.0f}) {
        CAPTURE(distance);
        CHECK(render_frame(*renderer, world, view_from(distance)).statistics.compiled == 0);
    }
}

TEST_CASE("plain below: what widens highlights and boxes of relief stay as they are") {
    Material material;
    CHECK_FALSE(has_fine_detail(material));
    material.normal_texture.image = {0};
    CHECK(has_fine_detail(material));
    CHECK_FALSE(has_fine_detail(without_fine_detail(material)));
    material.normal_mips = NormalMips::Toksvig;
    CHECK_FALSE(has_fine_detail(material));
    material = {};
    material.relief_texture.image = {0};
    material.detail = SurfaceDetail::Silhouette;
    CHECK(has_fine_detail(material));
    CHECK(without_fine_detail(material).detail == SurfaceDetail::Flat);
}

}  // namespace limn::test::plain_below_test
