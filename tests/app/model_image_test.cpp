// Models by themselves look right whatever light their file has.

#include "content/app/commands/headless.h"
#include "content/game/game.h"
#include "content/load/model_view.h"
#include "content/load/scene_load.h"
#include "content/make/models/shapes.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/light.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/gpu/readback.h"
#include "render/render_view.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace limn::model_image_test {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 90;

HeadlessRenderer& shared_renderer() {
    static Result<HeadlessRenderer> headless = create_headless_renderer();
    REQUIRE_MESSAGE(headless.ok(), (headless ? std::string() : headless.error().message));
    return *headless;
}

/// A white box on the floor with the lights that `add_lights` adds, framed and exposed.
gpu::ByteImage draw_box(
    const std::function<void(World&)>& add_lights, const std::string& backdrop = "studio",
    bool ground_in_file = false, float scale = 1) {
    World world;
    register_game_components();
    Assets assets;
    assets.meshes.push_back(make_box({.size = Vec3(scale)}));
    assets.meshes.push_back(make_box({.size = {300, 0.01f, 300}}));
    assets.materials.push_back({.base_color = {0.8f, 0.8f, 0.8f, 1}, .roughness = 0.9f});
    world.insert_resource(std::move(assets));
    world.insert_resource(FrameTime{});
    world.create(
        Transform{.position = {0, 0.5f * scale, 0}}, MeshInstance{.mesh = {0}, .material = {0}});
    if (ground_in_file) {
        world.create(
            Transform{.position = {0, -0.005f, 0}}, MeshInstance{.mesh = {1}, .material = {0}});
    }
    add_lights(world);
    const ModelView view = add_model_view(world, *load_backdrop(backdrop));
    start_world(world, add_game_systems);
    const RenderView camera =
        make_render_view(world, view.camera, {.width = kWidth, .height = kHeight});
    return gpu::read_bytes(*render_frame(*shared_renderer().renderer, world, camera).display);
}

/// Mean of green around a point, 0 .. 1; `y` from the top.
float green_at(const gpu::ByteImage& image, float x, float y) {
    const int px = static_cast<int>(x * kWidth);
    const int py = static_cast<int>(y * kHeight);
    float sum = 0;
    for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
            const std::size_t at =
                static_cast<std::size_t>((py + j) * kWidth + px + i) * image.channels;
            sum += static_cast<float>(image.pixels[at + 1]) / 255.0f;
        }
    }
    return sum / 25;
}

/// Over all values of all pixels.
int largest_difference(const gpu::ByteImage& a, const gpu::ByteImage& b) {
    REQUIRE(a.pixels.size() == b.pixels.size());
    int largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
    }
    return largest;
}

void add_sun(World& world, float lux) {
    world.create(
        Transform{.rotation = look_along({-0.5f, -0.8f, -0.6f})},
        DirectionalLight{.illuminance = lux});
}

}  // namespace

TEST_CASE("model image: suns of any illuminance give the same image, neither black nor clipped") {
    const gpu::ByteImage one = draw_box([](World& world) { add_sun(world, 1); });
    const float front = green_at(one, 0.45f, 0.55f);
    CHECK(front > 0.4f);
    CHECK(front < 0.97f);
    for (const float lux : {6830.0f, 0.02f}) {
        CAPTURE(lux);
        const gpu::ByteImage other = draw_box([lux](World& world) { add_sun(world, lux); });
        int different = 0;
        for (std::size_t i = 0; i < one.pixels.size(); ++i) {
            different += std::abs(one.pixels[i] - other.pixels[i]) > 2 ? 1 : 0;
        }
        CHECK(different == 0);
    }
}

TEST_CASE("model image: without light, and with a lamp of any power, the front is as bright") {
    const float studio = green_at(draw_box([](World&) {}), 0.45f, 0.55f);
    CHECK(studio > 0.4f);
    CHECK(studio < 0.97f);
    for (const float candela : {1.0f, 54000.0f}) {  // unitless, and 1,000 W as Blender writes it
        CAPTURE(candela);
        const gpu::ByteImage lamp = draw_box([candela](World& world) {
            world.create(
                Transform{.position = {1, 2, 3}}, PointLight{.intensity = candela, .radius = 0});
        });
        CHECK(green_at(lamp, 0.45f, 0.55f) > 0.4f);
        CHECK(green_at(lamp, 0.45f, 0.55f) < 0.97f);
    }
}

TEST_CASE("model image: a box of 0.1 mm and one of 100 km look like one of 1 m, with its shadow") {
    const gpu::ByteImage one = draw_box([](World&) {});
    for (const float scale : {1e-4f, 300.0f, 2e4f, 1e5f}) {
        CAPTURE(scale);
        const gpu::ByteImage other = draw_box([](World&) {}, "studio", false, scale);
        CHECK(largest_difference(one, other) <= 2);
    }
}

TEST_CASE("model image: the reports of sizes and of far nodes show the same box") {
    std::optional<gpu::ByteImage> reference;
    for (const char* const name : {"near", "tiny", "huge", "s20000", "far", "cancel"}) {
        const auto path = test::shared_report(std::string("20-far-away/") + name + ".gltf");
        if (!path) {
            return;
        }
        CAPTURE(name);
        World world;
        const Result<LoadedScene> scene = load_scene(world, *path);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        start_world(world, add_game_systems);
        const RenderView view =
            make_render_view(world, scene->camera, {.width = kWidth, .height = kHeight});
        const gpu::ByteImage image =
            gpu::read_bytes(*render_frame(*shared_renderer().renderer, world, view).display);
        if (!reference) {
            reference = image;
        }
        CHECK(largest_difference(*reference, image) <= 2);
    }
}

TEST_CASE("model image: a wide model is inside upright, square and wide images") {
    World world;
    register_game_components();
    Assets assets;
    assets.meshes.push_back(make_box({.size = {12, 1, 2}}));
    assets.materials.push_back({});
    world.insert_resource(std::move(assets));
    world.insert_resource(FrameTime{});
    world.create(Transform{}, MeshInstance{.mesh = {0}, .material = {0}});
    const ModelView model = add_model_view(world, *load_backdrop("studio"));
    start_world(world, add_game_systems);
    for (const auto& [width, height] : {std::pair(100, 400), {300, 300}, {480, 360}, {800, 200}}) {
        CAPTURE(width);
        const RenderView view =
            make_render_view(world, model.camera, {.width = width, .height = height});
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            const Vec4 clip = view.clip_from_world
                              * Vec4(center(model.subject) + half_extent(model.subject) * sides, 1);
            CHECK(std::abs(clip.x) < clip.w);
            CHECK(std::abs(clip.y) < clip.w);
        }
    }
}

TEST_CASE("model image: a huge ground in the file does not make the model a dot") {
    const gpu::ByteImage plain = draw_box([](World& world) { add_sun(world, 3); });
    const gpu::ByteImage ground = draw_box([](World& world) { add_sun(world, 3); }, "studio", true);
    CHECK(std::abs(green_at(plain, 0.45f, 0.55f) - green_at(ground, 0.45f, 0.55f)) < 0.05f);
}

TEST_CASE("model image: the ground fades into every backdrop") {
    for (const char* const backdrop : {"studio", "sky", "gray"}) {
        CAPTURE(backdrop);
        const gpu::ByteImage image = draw_box([](World&) {}, backdrop);
        // No step from row to row at the sides, where the disc ends.
        for (const float x : {0.05f, 0.95f}) {
            for (int y = 4; y < kHeight - 6; ++y) {
                const float above = green_at(image, x, static_cast<float>(y) / kHeight);
                const float below = green_at(image, x, static_cast<float>(y + 1) / kHeight);
                CHECK(std::abs(above - below) < 0.05f);
            }
        }
    }
}

}  // namespace limn::model_image_test
