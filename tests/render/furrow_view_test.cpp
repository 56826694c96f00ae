// Furrows on entities: their images are uploaded to materials, and visualized by the views of the
// editor.

#include "content/bake/furrow_skin.h"
#include "content/make/patterns/furrow_patterns.h"
#include "render/material/furrow_pass.h"
#include "render/material/image_pool.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn::test::furrow_view_test {
namespace {

constexpr int kSize = 128;

/// A square of furrows, 1 m along each side, that fills the image from (0, 0, 0.5).
class FurrowScene : public Scene {
  public:
    explicit FurrowScene(const std::vector<FurrowArrow>& arrows = {{}}) {
        MeshData mesh = make_furrow_surface(FurrowSurface::Square);
        mesh.tangents.assign(mesh.positions.size(), {1, 0, 0, 1});
        mesh.bounds = {{-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}};
        ImageData image;
        image.name = "flat";
        image.width = image.height = kSize;
        for (int i = 0; i < kSize * kSize; ++i) {
            image.pixels.insert(image.pixels.end(), {128, 128, 255, 255});
        }
        const ImageId normals = add(image);
        const ImageId heights = add(image);
        Material material = {.roughness = 0.6f};
        material.normal_texture.image = normals;
        square = place(add(mesh), add(material), at({0, 0, 0}));
        world.add(square, Furrows{.normals = normals, .heights = heights, .arrows = arrows});
        shine(DirectionalLight{.illuminance = 3}, look_at({1, 1, 0.4f}, {0, 0, 0}));
        world.insert_resource(Exposure{.curve = ToneCurve::Linear});
    }
    void show(const FurrowView& view) { world.add(square, view); }
    /// The displayed image, as RGBA bytes.
    gpu::ByteImage shot(int size = 512) {
        world.run(update_furrow_skins);
        const RenderView view = look({0, 0, 0.5f}, {0, 0, 0}, size, size);
        return gpu::read_bytes(*render_frame(shared_renderer(), world, view).display);
    }
    const FurrowSkin& skin() { return *std::as_const(world).find<FurrowSkin>(square); }
    const MeshData& mesh() { return world.resource<Assets>().meshes[0]; }

    Entity square;
};

/// Column and row of a point of the square in an image of `size` pixels.
IVec2 pixel_of(const Vec2& p, int size) {
    return IVec2(glm::floor((Vec2(p.x, -p.y) + 0.5f) * static_cast<float>(size)));
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "image pool: replaced pixels reach every mip level of their image alone") {
    std::vector<ImageData> images(2);
    for (ImageData& image : images) {
        image.name = "gray";
        image.width = image.height = 64;
        image.pixels.assign(4 * 64 * 64, 128);
    }
    ImagePool pool(device());
    pool.update(images);
    pool.replace({1}, std::vector<std::uint8_t>(4 * 64 * 64, 255));
    pool.replace({0}, std::vector<std::uint8_t>(7, 255));  // too few
    pool.replace({5}, std::vector<std::uint8_t>(7, 255));  // no image
    const gpu::Texture& array = pool.array(pool.find({1}).array);
    for (int level = 0; level < 7; ++level) {
        CAPTURE(level);
        CHECK(gpu::read_floats(array, level, 0).at(0, 0, 0) < 0.51f);
        CHECK(gpu::read_floats(array, level, 1).at(0, 0, 0) == 1);
    }
}

TEST_CASE_FIXTURE(
    FurrowScene, "furrow view: regrown furrows are visible in the next frame"
                     * technique("wrinkle.furrow.view-modes")) {
    const gpu::ByteImage furrowed = shot();
    world.get<Furrows>(square).style.seed = 5;
    CHECK(shot().pixels != furrowed.pixels);
    world.get<Furrows>(square).style.seed = 1;
    CHECK(shot().pixels == furrowed.pixels);
    // Smooth skin is even; furrowed skin is not.
    const auto spread = [](const gpu::ByteImage& image) {
        int low = 255;
        int high = 0;
        const int size = image.width;
        for (int y = size / 4; y < size * 3 / 4; ++y) {
            for (int x = size / 4; x < size * 3 / 4; ++x) {
                low = std::min<int>(low, image.at(x, y, 0));
                high = std::max<int>(high, image.at(x, y, 0));
            }
        }
        return high - low;
    };
    CHECK(spread(furrowed) > 20);
    CHECK(spread(shot(48)) > 10);  // smaller than the image: by its mip levels
    show({.mode = FurrowMode::Overview});
    CHECK(spread(shot()) <= 12);  // lighting is slightly uneven
}

TEST_CASE(
    "furrow view: two lines for each vertex, or only for edited ones"
    * technique("wrinkle.furrow.view-modes")) {
    FurrowScene scene({{{0.2f, 0.1f, 0}}, {{-0.3f, 0, 0}}, {{0, 0.4f, 0}}});
    scene.world.run(update_furrow_skins);
    const auto lines = [&](const FurrowView& view) {
        const auto marks = furrow_marks(scene.mesh(), scene.skin(), view);
        return std::ranges::count_if(
            marks, [](const FurrowMark& mark) { return mark.from != mark.to; });
    };
    const auto vertices = static_cast<std::ptrdiff_t>(scene.mesh().positions.size());
    CHECK(lines({}) == 2 * vertices);
    CHECK(lines({.only_edited = true}) == 2 * 3);
    // A line is as long as its vector is strong.
    const auto marks = furrow_marks(scene.mesh(), scene.skin(), {.only_edited = true, .length = 3});
    CHECK(glm::distance(marks[0].to, marks[0].from + Vec3(0, 3, 0)) < 1e-5f);
}

TEST_CASE_FIXTURE(
    FurrowScene,
    "furrow view: vertices are blue, the first field red, the second green, faces white"
        * technique("wrinkle.furrow.view-modes")) {
    show({.length = 0.01f});
    constexpr int kPixels = 1024;
    const gpu::ByteImage image = shot(kPixels);
    const auto color_at = [&](const Vec2& p) {
        const IVec2 at = pixel_of(p, kPixels);
        return IVec3(image.at(at.x, at.y, 0), image.at(at.x, at.y, 1), image.at(at.x, at.y, 2));
    };
    int wrong = 0;
    for (int j = 8; j < 24; ++j) {
        for (int i = 8; i < 24; ++i) {
            const Vec2 p = Vec2(i, j) / 32.0f - 0.5f;
            wrong += color_at(p) != IVec3(0, 0, 255) ? 1 : 0;
            wrong += color_at(p + Vec2(0, 0.006f)) != IVec3(255, 0, 0) ? 1 : 0;
            wrong += color_at(p + Vec2(0.006f, 0)) != IVec3(0, 255, 0) ? 1 : 0;
            const IVec3 face = color_at(p + Vec2(0.0156f, 0.0156f));
            wrong += face.x != face.y || face.y != face.z || face.x < 180 ? 1 : 0;
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE_FIXTURE(
    FurrowScene, "furrow view: the brightness of the height field is its height"
                     * technique("wrinkle.furrow.view-modes")) {
    show({.mode = FurrowMode::Height});
    const gpu::ByteImage image = shot(kSize);
    int off = 0;
    int dark = 0;
    for (int y = 4; y < kSize - 4; ++y) {
        for (int x = 4; x < kSize - 4; ++x) {
            const float height = skin().height[static_cast<std::size_t>(y * kSize + x)];
            const int expected =
                static_cast<int>(std::lround(255 * std::clamp(height, 0.0f, 1.0f)));
            off += std::abs(image.at(x, y, 0) - expected) > 4 ? 1 : 0;
            dark += image.at(x, y, 0) < 200 ? 1 : 0;
        }
    }
    CHECK(off <= kSize * kSize / 200);
    CHECK(dark > 200);
}

TEST_CASE_FIXTURE(
    FurrowScene, "furrow view: objects in front of the mesh hide its view"
                     * technique("wrinkle.furrow.view-modes")) {
    show({.mode = FurrowMode::Vectors});
    Material gray = {.shading = ShadingModel::Unlit, .base_color = {0.2f, 0.2f, 0.2f, 1}};
    place(add(make_square()), add(gray), affine_from({-0.5f, 0, 0.2f}, {1, 0, 0, 0}, {0.5f, 1, 1}));
    const gpu::ByteImage image = shot();
    int left = 0;
    int right = 0;
    for (int y = 0; y < 512; ++y) {
        for (int x = 0; x < 512; ++x) {
            const bool blue = image.at(x, y, 2) > image.at(x, y, 0) + 60;
            (x < 256 ? left : right) += blue ? 1 : 0;
        }
    }
    CHECK(left == 0);
    CHECK(right > 500);
}

TEST_CASE_FIXTURE(
    FurrowScene, "furrow view: in a small image of a dense mesh faces stay visible between marks"
                     * technique("wrinkle.furrow.view-modes")) {
    show({.mode = FurrowMode::Vectors});
    for (const int size : {512, 40, 20}) {  // the last has less than one pixel per vertex
        CAPTURE(size);
        const gpu::ByteImage image = shot(size);
        double face = 0;
        double marks = 0;  // faces are gray, marks are not
        for (int y = 2; y < size - 2; ++y) {
            for (int x = 2; x < size - 2; ++x) {
                const auto [low, high] =
                    std::minmax({image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)});
                face += low;
                marks += high - low;
            }
        }
        const double pixels = (size - 4.0) * (size - 4.0);
        CHECK(face / pixels > 80);
        CHECK(marks / pixels > 10);
    }
}

}  // namespace limn::test::furrow_view_test
