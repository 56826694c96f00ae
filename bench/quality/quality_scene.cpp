#include "bench/quality/quality_scene.h"

#include "content/make/models/masonry.h"
#include "content/make/models/shapes.h"
#include "ecs/base/text.h"
#include "ecs/components/camera.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/transform.h"
#include "render/render_frame.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace limn {

using glm::dvec3;
using oracle::LightImage;

namespace {

float encoded(float linear) {
    const float x = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;  // NaN becomes 0
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

/// Appends an asset and returns its id.
template <typename Id, typename T>
Id append(std::vector<T>& assets, T asset) {
    assets.push_back(std::move(asset));
    return {static_cast<std::uint32_t>(assets.size() - 1)};
}

dvec3 column(const Affine& pose, int c) {
    return {pose.row[0][c], pose.row[1][c], pose.row[2][c]};
}

}  // namespace

QualityScene::QualityScene() {
    world.insert_resource(Assets{});
}

MeshId QualityScene::add(MeshData mesh) {
    return append<MeshId>(world.resource<Assets>().meshes, std::move(mesh));
}

MaterialId QualityScene::add(Material material) {
    return append<MaterialId>(world.resource<Assets>().materials, std::move(material));
}

ImageId QualityScene::add(ImageData image) {
    return append<ImageId>(world.resource<Assets>().images, std::move(image));
}

SkinId QualityScene::add(SkinData skin) {
    return append<SkinId>(world.resource<Assets>().skins, std::move(skin));
}

Entity QualityScene::place(MeshId mesh, MaterialId material, const Affine& pose) {
    return world.create(
        MeshInstance{mesh, material}, WorldTransform{pose}, PreviousWorldTransform{pose});
}

gpu::FloatImage QualityScene::render(HeadlessRenderer& headless, const RenderView& view) const {
    return gpu::read_floats(*render_frame(*headless.renderer, world, view).radiance);
}

gpu::FloatImage
QualityScene::radiance(HeadlessRenderer& headless, const RenderView& view, int samples) const {
    return gpu::read_floats(*render_accumulated(*headless.renderer, world, view, samples).radiance);
}

Affine placed_at(const Vec3& position, float scale) {
    return affine_from(position, {1, 0, 0, 0}, Vec3(scale));
}

MeshData quality_square() {
    MeshData mesh;
    mesh.name = "square";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    for (const Vec3& position : mesh.positions) {
        grow(mesh.bounds, position);
    }
    return mesh;
}

void add_daylight(QualityScene& scene) {
    scene.world.insert_resource(Environment{
        .sky = SkyKind::Gradient,
        .zenith = {0.25f, 0.4f, 0.75f},
        .horizon = {0.75f, 0.8f, 0.85f},
        .ground = {0.2f, 0.19f, 0.17f}});
    scene.add_light(
        DirectionalLight{.color = {1, 0.95f, 0.85f}, .illuminance = 2},
        look_at({0, 0, 0}, {-0.4f, -1, -0.6f}));
}

void populate_court(QualityScene& scene) {
    const MaterialId floor =
        scene.add(Material{.base_color = {0.55f, 0.52f, 0.47f, 1}, .roughness = 0.9f});
    const MaterialId stone =
        scene.add(Material{.base_color = {0.62f, 0.57f, 0.48f, 1}, .roughness = 0.9f});
    const MaterialId clay =
        scene.add(Material{.base_color = {0.55f, 0.2f, 0.1f, 1}, .roughness = 0.7f});
    const MaterialId blue =
        scene.add(Material{.base_color = {0.1f, 0.2f, 0.38f, 1}, .roughness = 0.6f});

    scene.place(scene.add(make_box({.size = {14, 0.2f, 14}})), floor, placed_at({0, -0.1f, 0}));
    scene.place(
        scene.add(make_wall(
            {.size = {16, 3.6f, 0.4f},
             .span = 1.3f,
             .spring = 1.2f,
             .rise = 1.2f,
             .segments = 10})),
        stone, placed_at({-0.6f, 0, -2.6f}));
    const MeshId column = scene.add(make_lathe(
        {.profile =
             {{0.3f, 0}, {0.3f, 0.12f}, {0.19f, 0.24f}, {0.16f, 2}, {0.28f, 2.2f}, {0.28f, 2.35f}},
         .segments = 24}));
    for (const float x : {-2.7f, 1.0f}) {
        scene.place(column, stone, placed_at({x, 0, -1.3f}));
    }
    scene.place(
        scene.add(make_box({.size = {1, 0.5f, 1}})), stone,
        affine_from({-0.9f, 0.25f, 0.1f}, glm::angleAxis(0.4f, Vec3(0, 1, 0)), Vec3(1)));
    scene.place(
        scene.add(make_sphere({.radius = 0.34f, .segments = 32, .rings = 16})), blue,
        placed_at({-0.9f, 0.9f, 0.1f}));
    scene.place(
        scene.add(make_torus({.radius = 0.6f, .tube = 0.09f, .segments = 48, .sides = 16})), clay,
        affine_from({-0.9f, 1.05f, 0.1f}, glm::angleAxis(1.15f, Vec3(1, 0, 0.35f)), Vec3(1)));
    const MeshId bar = scene.add(make_cylinder({.radius = 0.03f, .height = 0.9f, .segments = 10}));
    for (int i = 0; i < 7; ++i) {
        scene.place(bar, clay, placed_at({0.55f + 0.22f * static_cast<float>(i), 0.45f, 0.75f}));
    }
    scene.place(
        scene.add(make_box({.size = {1.6f, 0.07f, 0.07f}})), clay,
        placed_at({1.21f, 0.93f, 0.75f}));
}

RenderView court_view(int width, int height) {
    return quality_view(kCourtEye, kCourtTarget, width, height, radians(42.0f));
}

RenderView quality_view(const Vec3& eye, const Vec3& target, int width, int height, float fov_y) {
    const Affine pose = look_at(eye, target);
    return make_render_view(
        {.fov_y = fov_y, .near = 0.05f}, pose, pose, {.width = width, .height = height});
}

dvec3 pixel_ray(const RenderView& view, double x, double y) {
    const Affine& pose = view.world_from_camera;
    const double right = (2 * (x + 0.5) / view.width - 1) * static_cast<double>(view.tangent.x);
    const double up = (1 - 2 * (y + 0.5) / view.height) * static_cast<double>(view.tangent.y);
    return right * column(pose, 0) + up * column(pose, 1) - column(pose, 2);
}

dvec3 eye_of(const RenderView& view) {
    return column(view.world_from_camera, 3);
}

Result<LevelView> open_level_view(const std::string& level, const IVec2& size) {
    LevelView made{.stage = LIMN_TRY(open_stage(level)), .view = {}, .exposure = {}};
    World& world = made.stage->world;
    static_cast<void>(advance_stage(*made.stage, 1));
    const std::optional<Entity> camera = find_camera(world);
    if (!camera) {
        return fail("level {}: found no camera, expected one", level);
    }
    made.view = make_render_view(world, *camera, {.width = size.x, .height = size.y});
    if (const auto* exposure = world.find_resource<Exposure>()) {
        made.exposure = *exposure;
    }
    return made;
}

ColorImage displayed(const gpu::FloatImage& radiance) {
    ColorImage image{.width = radiance.width, .height = radiance.height, .pixels = {}};
    image.pixels.reserve(static_cast<std::size_t>(image.width) * image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            image.pixels.emplace_back(
                encoded(radiance.at(x, y, 0)), encoded(radiance.at(x, y, 1)),
                encoded(radiance.at(x, y, 2)));
        }
    }
    return image;
}

ColorImage color_image(const gpu::ByteImage& bytes) {
    ColorImage image{.width = bytes.width, .height = bytes.height, .pixels = {}};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            image.pixels.push_back(
                Vec3(bytes.at(x, y, 0), bytes.at(x, y, 1), bytes.at(x, y, 2)) / 255.0f);
        }
    }
    return image;
}

LightImage read_light_image(const gpu::Texture& texture) {
    const gpu::FloatImage floats = gpu::read_floats(texture);
    LightImage image = oracle::make_black_image(floats.width, floats.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            image.pixels[y * image.width + x] = {
                floats.at(x, y, 0), floats.at(x, y, 1), floats.at(x, y, 2)};
        }
    }
    return image;
}

gpu::Texture upload_light(const LightImage& image) {
    std::vector<Vec4> texels;
    for (int y = image.height - 1; y >= 0; --y) {  // bottom row first
        for (int x = 0; x < image.width; ++x) {
            texels.emplace_back(Vec3(image.at(x, y)), 1.0f);
        }
    }
    gpu::Texture texture(
        "radiance", {.format = GL_RGBA32F, .width = image.width, .height = image.height});
    texture.upload<Vec4>(texels, GL_RGBA, GL_FLOAT);
    return texture;
}

gpu::ByteImage ImageBench::display(const gpu::Texture& radiance, const Exposure& exposure) {
    return gpu::read_bytes(run(radiance, [&](FrameGraph& frame, TextureId image) {
        return apply_tone_mapper(frame, tone_mapper, exposure, std::nullopt, image);
    }));
}

ColorImage ImageBench::display(const LightImage& radiance, const Exposure& exposure) {
    return color_image(display(upload_light(radiance), exposure));
}

double percent_error(double found, double exact) {
    return 100 * std::abs(found - exact) / exact;
}

double largest_relative_error(const gpu::FloatImage& found, const gpu::FloatImage& expected) {
    double largest = 0;
    double brightest = 1e-9;
    for (int y = 0; y < expected.height; ++y) {
        for (int x = 0; x < expected.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double want = expected.at(x, y, c);
                largest = std::max(largest, std::abs(found.at(x, y, c) - want));
                brightest = std::max(brightest, want);
            }
        }
    }
    return largest / brightest;
}

}  // namespace limn
