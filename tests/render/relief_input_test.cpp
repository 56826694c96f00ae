// Relief on meshes and maps that are odd: it is drawn as well as it can be, and never with NaN.

#include "ecs/components/shadow.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace limn::test::relief_input_test {
namespace {

constexpr int kSize = 48;
constexpr float kDepth = 0.3f;
constexpr SurfaceDetail kDetails[] = {SurfaceDetail::Bump,      SurfaceDetail::Parallax,
                                      SurfaceDetail::Occlusion, SurfaceDetail::Relief,
                                      SurfaceDetail::Cone,      SurfaceDetail::DoubleDepth,
                                      SurfaceDetail::Silhouette};

/// A pyramid that is the same from left and right, its normals included.
ImageData symmetric_map() {
    constexpr int kTexels = 32;
    ImageData image = {.name = "roof", .width = kTexels, .height = kTexels, .pixels = {}};
    for (int y = 0; y < kTexels; ++y) {
        for (int x = 0; x < kTexels; ++x) {
            const double off = std::abs((x + 0.5) * 2 / kTexels - 1);
            image.pixels.insert(
                image.pixels.end(),
                {128, 128, 255, static_cast<std::uint8_t>(std::lround(255 * off))});
        }
    }
    return image;
}

ImageData flat_map(std::uint8_t depth) {
    return {.name = "flat", .width = 1, .height = 1, .pixels = {128, 128, 255, depth}};
}

/// The same texels as floats, `texel` replaced by `value`.
ImageData as_floats(const ImageData& from, std::size_t texel, float value) {
    ImageData image = from;
    image.name = "floats";
    image.format = PixelFormat::Rgba32F;
    std::vector<float> values;
    for (const std::uint8_t byte : from.pixels) {
        values.push_back(static_cast<float>(byte) / 255);
    }
    if (texel < values.size() / 4) {
        std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(4 * texel), 4, value);
    }
    image.pixels.resize(values.size() * sizeof(float));
    std::memcpy(image.pixels.data(), values.data(), image.pixels.size());
    return image;
}

struct OddScene : Scene {
    OddScene() : roof(add(symmetric_map())) {}

    gpu::FloatImage
    draw(const MeshData& mesh, ImageId map, SurfaceDetail detail, float depth = kDepth) {
        world.clear();
        world.create(
            DirectionalLight{.illuminance = 4}, WorldTransform{look_at({0.4f, 1, 2}, {0, 0, 0})},
            Shadow{.resolution = 256});
        Material stone = {.base_color = {0.8f, 0.7f, 0.6f, 1}, .roughness = 0.7f};
        stone.detail = detail;
        stone.relief_depth = depth;
        stone.relief_texture = {.image = map};
        stone.relief_shadow = ReliefShadow::Ray;
        place(add(mesh), add(stone), at({0, 0, 0}));
        return radiance(look({0.9f, -0.7f, 1.1f}, {0, 0, 0}, kSize, kSize));
    }

    ImageId roof;
};

bool all_finite(const gpu::FloatImage& image) {
    return std::all_of(
        image.pixels.begin(), image.pixels.end(), [](float value) { return std::isfinite(value); });
}

/// Of pixels that are not the background.
int drawn_pixels(const gpu::FloatImage& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            count += image.at(x, y, 0) > 0 ? 1 : 0;
        }
    }
    return count;
}

}  // namespace

TEST_CASE_FIXTURE(
    OddScene, "relief input: texture coordinates without area leave the mesh as it is, without NaN"
                  * technique("relief.selection")) {
    MeshData mesh = make_square();
    const int expected = drawn_pixels(draw(mesh, roof, SurfaceDetail::Flat));
    mesh.uvs.assign(mesh.uvs.size(), Vec2(0.5f, 0.5f));
    for (const SurfaceDetail detail : kDetails) {
        CAPTURE(static_cast<int>(detail));
        const gpu::FloatImage image = draw(mesh, roof, detail);
        CHECK(all_finite(image));
        CHECK(drawn_pixels(image) >= expected / 2);
    }
}

TEST_CASE_FIXTURE(
    OddScene, "relief input: mirrored texture coordinates show a symmetric relief as before"
                  * technique("relief.tangent")) {
    const MeshData mesh = make_square();
    MeshData mirrored = mesh;
    for (Vec2& uv : mirrored.uvs) {
        uv.x = 1 - uv.x;
    }
    for (Vec4& tangent : mirrored.tangents) {
        tangent = Vec4(-Vec3(tangent), -tangent.w);
    }
    for (const SurfaceDetail detail : kDetails) {
        CAPTURE(static_cast<int>(detail));
        const gpu::FloatImage straight = draw(mesh, roof, detail);
        // 128 is not quite the middle of a byte: normals lean by half a step.
        CHECK(largest_difference(draw(mirrored, roof, detail), straight) <= 0.03f);
    }
}

TEST_CASE_FIXTURE(
    OddScene, "relief input: without tangents it is drawn without relief, not broken"
                  * technique("relief.selection")) {
    MeshData mesh = make_square();
    mesh.tangents.clear();
    for (const SurfaceDetail detail : kDetails) {
        CAPTURE(static_cast<int>(detail));
        const gpu::FloatImage image = draw(mesh, roof, detail);
        CHECK(all_finite(image));
        CHECK(drawn_pixels(image) > kSize * kSize / 8);
    }
}

TEST_CASE_FIXTURE(
    OddScene, "relief input: a depth of 0, of the map or the material, is the mesh itself"
                  * technique("relief.search")) {
    const MeshData mesh = make_square();
    const ImageId none = add(flat_map(0));
    const gpu::FloatImage flat = draw(mesh, none, SurfaceDetail::Flat);
    for (const SurfaceDetail detail : kDetails) {
        if (detail == SurfaceDetail::Parallax) {
            continue;  // which shifts by the height above the middle
        }
        CAPTURE(static_cast<int>(detail));
        CHECK(largest_difference(draw(mesh, none, detail), flat) <= 0.02f);
        const gpu::FloatImage thin = draw(mesh, none, detail, 0);
        CHECK(all_finite(thin));
        CHECK(largest_difference(thin, flat) <= 0.02f);
    }
}

TEST_CASE_FIXTURE(
    OddScene, "relief input: a map of floats is drawn as one of bytes, and NaN in it stays in it"
                  * technique("relief.map-format")) {
    const MeshData mesh = make_square();
    const ImageId floats = add(as_floats(symmetric_map(), ~std::size_t{0}, 0));
    const ImageId broken =
        add(as_floats(symmetric_map(), 500, std::numeric_limits<float>::quiet_NaN()));
    const ImageId endless =
        add(as_floats(symmetric_map(), 500, std::numeric_limits<float>::infinity()));
    for (const SurfaceDetail detail : kDetails) {
        CAPTURE(static_cast<int>(detail));
        CHECK(largest_difference(draw(mesh, floats, detail), draw(mesh, roof, detail)) <= 0.03f);
        CHECK(all_finite(draw(mesh, broken, detail)));
        CHECK(all_finite(draw(mesh, endless, detail)));
    }
}

}  // namespace limn::test::relief_input_test
