// Bump mapping, parallax mapping and relief of one map: materials that differ in `detail` alone.

#include "ecs/components/light.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace limn::test::relief_compare_test {
namespace {

constexpr int kSize = 96;
constexpr float kTile = 2;
constexpr float kDepth = 0.06f * kTile;
constexpr SurfaceDetail kMethods[] = {
    SurfaceDetail::Bump, SurfaceDetail::Parallax, SurfaceDetail::Relief};

/// Waves of color and, if `depth` < 0, of depth, else that depth everywhere.
ImageData waves(bool color, int depth) {
    constexpr int kTexels = 128;
    ImageData image = {.name = "waves", .width = kTexels, .height = kTexels, .pixels = {}};
    for (int i = 0; i < kTexels * kTexels; ++i) {
        const auto phase = [](int texel) { return 6 * kPi * (texel + 0.5) / kTexels; };
        const double x = phase(i % kTexels);
        const double y = phase(i / kTexels);
        const auto byte = [](double value) {
            return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * value));
        };
        const double height = 0.9 * std::sin(x) * std::sin(y);  // depth = (1 - height) / 2
        // Of 1/2 * 0.06 tiles, per tile; v runs down.
        const double slope = 0.9 * 0.03 * 6 * kPi;
        const double across = -slope * std::cos(x) * std::sin(y);
        const double up = slope * std::sin(x) * std::cos(y);
        const double length = std::sqrt(across * across + up * up + 1);
        if (color) {
            image.pixels.insert(
                image.pixels.end(),
                {byte(0.7 * std::sin(2 * x)), byte(0.7 * std::sin(2 * y)), 90, 255});
        } else if (depth >= 0) {
            image.pixels.insert(
                image.pixels.end(), {128, 128, 255, static_cast<std::uint8_t>(depth)});
        } else {
            image.pixels.insert(
                image.pixels.end(), {byte(across / length), byte(up / length), 255, byte(-height)});
        }
    }
    return image;
}

/// The square, as fine as the waves and displaced by them.
MeshData displaced_square() {
    constexpr int kCells = 384;
    MeshData mesh;
    mesh.name = "displaced";
    for (int j = 0; j <= kCells; ++j) {
        for (int i = 0; i <= kCells; ++i) {
            const Vec2 uv = Vec2(i, j) / static_cast<float>(kCells);
            const Vec2 phase = 6 * kPi * uv;
            const float height = 0.9f * std::sin(phase.x) * std::sin(phase.y);
            const float slope = 0.9f * 0.03f * 6 * kPi;
            mesh.positions.emplace_back(
                kTile * (uv.x - 0.5f), kTile * (0.5f - uv.y), -0.5f * kDepth * (1 - height));
            mesh.normals.push_back(glm::normalize(Vec3(
                -slope * std::cos(phase.x) * std::sin(phase.y),
                slope * std::sin(phase.x) * std::cos(phase.y), 1)));
            mesh.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
            mesh.uvs.push_back(uv);
        }
    }
    for (std::uint32_t j = 0; j < kCells; ++j) {
        for (std::uint32_t i = 0; i < kCells; ++i) {
            const std::uint32_t a = j * (kCells + 1) + i;
            const std::uint32_t b = a + kCells + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    }
    mesh.bounds = {Vec3(-1, -1, -kDepth), Vec3(1, 1, 0)};
    return mesh;
}

struct CompareScene : Scene {
    gpu::FloatImage
    shown(SurfaceDetail detail, int depth, const RenderView& view, float height = 0) {
        world.clear();
        world.insert_resource(Assets{});
        shine(DirectionalLight{.illuminance = 3}, look_at({0.8f, 1, 1.6f}, {0, 0, 0}));
        Material stone = {
            .shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}};
        stone.base_color_texture = {.image = add(waves(true, 0))};
        stone.relief_texture = {.image = add(waves(false, depth))};
        stone.detail = detail;
        stone.relief_depth = kDepth;
        stone.relief_steps = 128;
        const bool real = detail == SurfaceDetail::Flat;
        place(add(real ? displaced_square() : make_square()), add(stone), at({0, 0, height}));
        return radiance(view);
    }
};

double mean_difference(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    int count = 0;
    for (int y = kSize / 4; y < 3 * kSize / 4; ++y) {
        for (int x = kSize / 4; x < 3 * kSize / 4; ++x) {
            const Vec3 difference = glm::abs(rgb_at(a, x, y) - rgb_at(b, x, y));
            sum += double(difference.x) + double(difference.y) + double(difference.z);
            ++count;
        }
    }
    return sum / count;
}

}  // namespace

TEST_CASE_FIXTURE(
    CompareScene,
    "relief compare: head on, waves are shaded the same by bump, parallax and relief mapping"
        * technique("relief.compare, bump.height-field")) {
    // All rays are normal, so none of the methods shifts the maps; what is left is the shading.
    // That of bump mapping is of depths in bytes, over two texels of 1/64 m each: its slopes are
    // off by up to 0.06 m / 255 * 64 / m = 0.015, others by 0.004 of their bytes. The three
    // channels together are at most 3 * 3 / pi.
    const Affine pose = look_at({0, 0, 200}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(0.9f / 200), .near = 1}, pose, pose,
        {.width = kSize, .height = kSize});
    const gpu::FloatImage bump = shown(SurfaceDetail::Bump, -1, view);
    const gpu::FloatImage flat = shown(SurfaceDetail::Flat, -1, view);
    CHECK(mean_difference(bump, shown(SurfaceDetail::Parallax, -1, view)) <= 0.019 * 9 / kPi);
    CHECK(mean_difference(bump, shown(SurfaceDetail::Relief, -1, view)) <= 0.019 * 9 / kPi);
    CHECK(mean_difference(bump, flat) <= 0.019 * 9 / kPi);  // displaced
    // Upside down they would be off by twice what the waves do to a flat map.
    CHECK(mean_difference(bump, shown(SurfaceDetail::Bump, 128, view)) > 0.15);
}

TEST_CASE_FIXTURE(
    CompareScene,
    "relief compare: head on and at half the depth bump, parallax and relief are the same"
        * technique("relief.compare")) {
    // A distant camera: all rays are normal. Bytes have no 1/2: the depth is off by 0.002, and
    // normals, which bump mapping does not read, are tilted by 0.004.
    const Affine pose = look_at({0, 0, 200}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(0.9f / 200), .near = 1}, pose, pose,
        {.width = kSize, .height = kSize});
    std::array<gpu::FloatImage, 3> images;
    for (std::size_t i = 0; i < images.size(); ++i) {
        images[i] = shown(kMethods[i], 128, view);
    }
    CHECK(mean_difference(images[0], images[0]) == 0);
    CHECK(mean_difference(images[0], images[1]) <= 6e-3);
    CHECK(mean_difference(images[0], images[2]) <= 6e-3);
    CHECK(rgb_at(images[0], 30, 30).x > 0.01f);
}

TEST_CASE_FIXTURE(
    CompareScene,
    "relief compare: at 20 degrees relief is nearer to the displaced mesh than parallax mapping, "
    "and that nearer than bump mapping"
        * technique("relief.compare")) {
    // Relief lies below its mesh; the other two leave the mesh where it is, so that its waves are
    // about it.
    for (const float degrees : {20.0f, 60.0f}) {
        const float angle = radians(degrees);
        const RenderView view =
            look({0, -std::cos(angle), std::sin(angle)}, {0, 0, 0}, kSize, kSize);
        const gpu::FloatImage below = shown(SurfaceDetail::Flat, -1, view);
        const gpu::FloatImage about = shown(SurfaceDetail::Flat, -1, view, 0.5f * kDepth);
        const double bump = mean_difference(shown(SurfaceDetail::Bump, -1, view), about);
        const double parallax = mean_difference(shown(SurfaceDetail::Parallax, -1, view), about);
        const double relief = mean_difference(shown(SurfaceDetail::Relief, -1, view), below);
        CAPTURE(degrees);
        CHECK(relief < 0.6 * parallax);
        CHECK(parallax < 0.7 * bump);
        CHECK(bump < 0.15);  // of 0.9: the slopes are those of the waves, too
    }
}

}  // namespace limn::test::relief_compare_test
