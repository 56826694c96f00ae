#include "ecs/components/texture_shade.h"
#include "ecs/components/time.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>

namespace limn::test::texture_shade_test {
namespace {

constexpr int kSide = 16;

template <typename Texel>
ImageData painted(Texel&& texel) {
    ImageData image;
    image.name = "painted";
    image.width = image.height = kSide;
    image.format = PixelFormat::Rgba32F;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const Vec4 color(texel(x, y), 1);
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(&color);
            image.pixels.insert(image.pixels.end(), bytes, bytes + sizeof(color));
        }
    }
    return image;
}

Vec3 normal_of(int x, int y) {
    const Vec2 p = (Vec2(x, y) + 0.5f) / (0.5f * kSide) - 1.0f;
    return glm::normalize(Vec3(0.8f * p.x, -0.7f * p.y, 1));
}

Vec3 color_of(int x, int y) {
    return {0.2f + 0.02f * static_cast<float>(x), 0.3f, 0.1f + 0.03f * static_cast<float>(y)};
}

/// Equations 4.12 to 4.14 of Bando 2001, per texel.
Vec3 lit(const TextureShade& shade, const Vec3& n, const Vec3& reflectance) {
    const Vec3 l = glm::normalize(shade.to_light);
    const Vec3 h = glm::normalize(l + Vec3(0, 0, 1));
    const float facing = glm::dot(n, l);
    const float highlight =
        facing > 0 ? std::pow(std::max(glm::dot(n, h), 0.0f), shade.shininess) : 0.0f;
    return reflectance * (shade.ambient + shade.light * std::max(facing, 0.0f))
           + Vec3(shade.light * shade.specular * highlight);
}

/// A square that fills the image, and a bare entity whose transform the normals follow.
class Shaded : public Scene {
  public:
    Shaded() {
        world.insert_resource(Exposure{});
        world.insert_resource(FrameTime{.step = 1.0f / 60});
        shade.normals = add(painted([](int x, int y) { return 0.5f + 0.5f * normal_of(x, y); }));
        shade.color = add(painted([](int x, int y) { return color_of(x, y); }));
        shade.target = add(painted([](int, int) { return Vec3(0); }));
        shade.to_light = {0.5f, 0.4f, 1};
        shade.shininess = 20;
        Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        material.base_color_texture.image = shade.target;
        material.base_color_texture.nearest = true;
        place(add(make_square()), add(material), at({0, 0, 0}));
    }
    /// The rendered color of every texel, `zoom` pixels wide.
    std::vector<Vec3> texels(const Quat& rotation = {1, 0, 0, 0}, int zoom = 4) {
        if (world.alive(easel)) {
            world.destroy(easel);
        }
        easel = world.create(shade, WorldTransform{affine_from({0, 0, 0}, rotation, Vec3(2.5f))});
        const gpu::FloatImage rendered =
            radiance(look({0, 0, 1}, {0, 0, 0}, zoom * kSide, zoom * kSide));
        std::vector<Vec3> found;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                found.push_back(rgb_at(rendered, zoom * x + zoom / 2, zoom * y + zoom / 2));
            }
        }
        return found;
    }

    TextureShade shade;
    Entity easel;
};

float largest_difference_of(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    float most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, glm::length(a[i] - b[i]));
    }
    return most;
}

template <typename Normal>
std::vector<Vec3> expected_texels(const TextureShade& shade, Normal&& normal) {
    std::vector<Vec3> expected;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            expected.push_back(lit(shade, normal(x, y), color_of(x, y)));
        }
    }
    return expected;
}

}  // namespace

TEST_CASE_FIXTURE(
    Shaded, "texture shade: every texel is lit like a pixel there"
                * technique("wrinkle.furrow.texture-space-shading")) {
    CHECK(largest_difference_of(texels(), expected_texels(shade, normal_of)) < 0.01f);
    shade.to_light = {0.9f, 0, -0.2f};  // below the horizon of most
    shade.shininess = 2;
    CHECK(largest_difference_of(texels(), expected_texels(shade, normal_of)) < 0.01f);
}

TEST_CASE_FIXTURE(
    Shaded, "texture shade: the size of the screen does not change a texel"
                * technique("wrinkle.furrow.texture-space-shading")) {
    CHECK(largest_difference_of(texels({1, 0, 0, 0}, 4), texels({1, 0, 0, 0}, 9)) == 0.0f);
}

TEST_CASE_FIXTURE(
    Shaded, "texture shade: normals rotate with the entity, light and view do not"
                * technique("wrinkle.furrow.texture-space-shading")) {
    const Quat turn = glm::angleAxis(0.5f, glm::normalize(Vec3(0.2f, 1, 0.1f)));
    const auto turned = [&](int x, int y) { return turn * normal_of(x, y); };
    CHECK(largest_difference_of(texels(turn), expected_texels(shade, turned)) < 0.01f);
}

TEST_CASE_FIXTURE(
    Shaded, "texture shade: turning normals and light together changes nothing"
                * technique("wrinkle.furrow.texture-space-shading")) {
    const std::vector<Vec3> before = texels();
    const Quat around = glm::angleAxis(1.1f, Vec3(0, 0, 1));  // the view stays the same
    shade.to_light = around * shade.to_light;
    CHECK(largest_difference_of(texels(around), before) < 0.01f);
    shade.specular = 0;
    shade.to_light = {0.2f, 0.1f, 1};
    const std::vector<Vec3> dull = texels();
    const Quat any = glm::angleAxis(0.4f, glm::normalize(Vec3(1, 0.3f, 0)));
    shade.to_light = any * shade.to_light;
    CHECK(largest_difference_of(texels(any), dull) < 0.01f);
}

TEST_CASE_FIXTURE(
    Shaded, "texture shade: normals of an unrolled cylinder are rolled up"
                * technique("wrinkle.furrow.texture-space-shading")) {
    shade.unrolled = true;
    const auto rolled = [](int x, int y) {
        const float s = 2 * kPi * (static_cast<float>(x) + 0.5f) / kSide;
        return glm::angleAxis(s, Vec3(0, 1, 0)) * normal_of(x, y);
    };
    CHECK(largest_difference_of(texels(), expected_texels(shade, rolled)) < 0.01f);
}

TEST_CASE_FIXTURE(
    Shaded, "texture shade: without an image, or if it reads its own target, nothing is drawn") {
    const TextureShade good = shade;
    for (const int missing : {0, 1, 2}) {
        shade = good;
        (missing == 0 ? shade.normals : shade.color) = {77};
        if (missing == 2) {
            shade = good;
            shade.normals = shade.target;
        }
        CHECK(texels()[5] == Vec3(0));
    }
}

}  // namespace limn::test::texture_shade_test
