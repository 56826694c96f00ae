// Colors and patterns of persons in one mesh, by the alpha of their vertex colors.

#include "ecs/components/dress.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace limn::test::dress_test {
namespace {

/// A square of a part, whose texture coordinates go from 0 to `extent`.
MeshData make_cloth(float alpha, float extent = 1) {
    MeshData mesh = make_square();
    mesh.colors.assign(4, Vec4(1, 1, 1, alpha));
    for (Vec2& uv : mesh.uvs) {
        uv *= extent;
    }
    return mesh;
}

Material make_dressed(const Dress& dress) {
    Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
    material.dress = dress;
    return material;
}

Dress with_shirt(ClothPattern pattern, float repeat) {
    return {.shirt = {.color = {1, 1, 1}, .ink = {0, 0, 0}, .pattern = pattern, .repeat = repeat}};
}

struct DressScene : Scene {
    /// Image of a shirt that fills it.
    gpu::FloatImage shirt(const Dress& dress, float extent, int size) {
        const MaterialId material = add(make_dressed(dress));
        const Entity square =
            place(add(make_cloth(alpha_of_part(DressedPart::Shirt), extent)), material, Affine{});
        gpu::FloatImage image = radiance(look({0, 0, 1}, {0, 0, 0}, size, size));
        world.destroy(square);
        return image;
    }
};

float mean_of(const gpu::FloatImage& image, int size) {
    double sum = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            sum += static_cast<double>(rgb_at(image, x, y).x);
        }
    }
    return static_cast<float>(sum / (size * size));
}

/// 1 - the ink at a point, in periods, with sharp edges.
float plain_cloth(ClothPattern pattern, float u, float v) {
    const auto pulse = [](float x, float duty) { return x - std::floor(x) < duty ? 1.0f : 0.0f; };
    const auto from_middle = [](float x) { return x - std::floor(x) - 0.5f; };
    const auto ink = [&] {
        switch (pattern) {
        case ClothPattern::None:
            break;
        case ClothPattern::Stripes:
            return pulse(u, 0.5f);
        case ClothPattern::Bands:
            return pulse(v, 0.5f);
        case ClothPattern::Checks:
            return 0.5f * (pulse(u, 0.5f) + pulse(v, 0.5f));
        case ClothPattern::Plaid:
            return 0.3f * (pulse(u, 0.5f) + pulse(v, 0.5f))
                   + 0.2f * (pulse(u + 0.3f, 0.08f) + pulse(v + 0.3f, 0.08f));
        case ClothPattern::Dots:
            return std::hypot(from_middle(u), from_middle(v)) < 0.28f ? 1.0f : 0.0f;
        case ClothPattern::Knit:
            return pulse(v + std::abs(from_middle(u)), 0.5f);
        case ClothPattern::Twill:
            return pulse(u + v, 0.5f);
        }
        return 0.0f;
    };
    return 1 - ink();
}

/// Mean of plain_cloth over each pixel of an image of `periods`.
std::vector<float> plain_image(ClothPattern pattern, float periods, int size) {
    constexpr int kSamples = 32;
    std::vector<float> image;
    const float scale = periods / static_cast<float>(size);
    for (int i = 0; i < size * size; ++i) {
        float sum = 0;
        for (int k = 0; k < kSamples * kSamples; ++k) {
            const float x =
                static_cast<float>(i % size) + (static_cast<float>(k % kSamples) + 0.5f) / kSamples;
            const float y =
                static_cast<float>(i / size) + (static_cast<float>(k / kSamples) + 0.5f) / kSamples;
            sum += plain_cloth(pattern, scale * x, scale * y);
        }
        image.push_back(sum / square(static_cast<float>(kSamples)));
    }
    return image;
}

/// Mean over all pixels of the absolute difference.
float mean_difference(const gpu::FloatImage& image, const std::vector<float>& other, int size) {
    float sum = 0;
    for (int i = 0; i < size * size; ++i) {
        sum += std::abs(rgb_at(image, i % size, i / size).x - other[static_cast<std::size_t>(i)]);
    }
    return sum / static_cast<float>(size * size);
}

}  // namespace

TEST_CASE_FIXTURE(
    DressScene, "dress: each part of a person has its own color, and shoes and eyes keep theirs"
                    * technique("engine.multi-material")) {
    const Dress dress = {
        .skin = {0.9f, 0.1f, 0.2f},
        .hair = {0.3f, 0.8f, 0.1f},
        .shirt = {.color = {0.2f, 0.3f, 0.7f}},
        .legs = {.color = {0.6f, 0.5f, 0.4f}}};
    const MaterialId material = add(make_dressed(dress));
    const std::array<std::pair<float, Vec3>, 6> parts = {
        {{alpha_of_part(DressedPart::Hair), dress.hair},
         {alpha_of_part(DressedPart::Skin), dress.skin},
         {alpha_of_part(DressedPart::Shirt), dress.shirt.color},
         {alpha_of_part(DressedPart::Legs), dress.legs.color},
         {alpha_of_part(DressedPart::Other), Vec3(1)},
         {1.0f, Vec3(1)}}};
    for (const auto& [alpha, color] : parts) {
        const Entity square = place(add(make_cloth(alpha)), material, Affine{});
        const Vec3 seen = rgb_at(radiance(look({0, 0, 1}, {0, 0, 0}, 8, 8)), 4, 4);
        for (int i = 0; i < 3; ++i) {
            CHECK(double(seen[i]) == near(double(color[i])).epsilon(4e-3).scale(0.5));
        }
        world.destroy(square);
    }
}

TEST_CASE_FIXTURE(
    DressScene, "dress: a pixel has the mean of the pattern over its area"
                    * technique("engine.multi-material")) {
    constexpr int kSize = 24;
    constexpr float kPeriods = 7.3f;  // 3.3 pixels each
    for (const ClothPattern pattern :
         {ClothPattern::Stripes, ClothPattern::Bands, ClothPattern::Checks, ClothPattern::Plaid}) {
        const gpu::FloatImage image = shirt(with_shirt(pattern, 0.05f), 0.05f * kPeriods, kSize);
        const std::vector<float> other = plain_image(pattern, kPeriods, kSize);
        float worst = 0;
        for (int i = 0; i < kSize * kSize; ++i) {
            const float seen = rgb_at(image, i % kSize, i / kSize).x;
            worst = std::max(worst, std::abs(seen - other[static_cast<std::size_t>(i)]));
        }
        CAPTURE(static_cast<int>(pattern));
        CHECK(worst < 0.02f);
    }
}

TEST_CASE_FIXTURE(
    DressScene, "dress: close by, each pattern has its period, its contrast and its shape"
                    * technique("engine.multi-material")) {
    constexpr int kSize = 64;
    constexpr int kPeriods = 2;
    constexpr int kPeriod = kSize / kPeriods;  // [px]
    constexpr int kFirst = static_cast<int>(ClothPattern::Stripes);
    constexpr int kLast = static_cast<int>(ClothPattern::Twill);
    std::vector<std::vector<float>> plain;
    for (int i = kFirst; i <= kLast; ++i) {
        plain.push_back(plain_image(static_cast<ClothPattern>(i), kPeriods, kSize));
    }
    for (int i = kFirst; i <= kLast; ++i) {
        CAPTURE(i);
        const auto pattern = static_cast<ClothPattern>(i);
        const gpu::FloatImage image = shirt(with_shirt(pattern, 0.05f), 0.05f * kPeriods, kSize);
        for (int other = kFirst; other <= kLast; ++other) {
            CAPTURE(other);
            const float difference =
                mean_difference(image, plain[static_cast<std::size_t>(other - kFirst)], kSize);
            CHECK((other == i ? difference < 0.015f : difference > 0.15f));
        }
        float repeats = 0;  // largest difference of what is a period apart
        Vec2 range = {1, 0};
        for (int k = 0; k < kSize * kPeriod; ++k) {
            const int x = k % kPeriod;
            const int y = k / kPeriod;
            const float here = rgb_at(image, x, y).x;
            repeats = std::max(repeats, std::abs(rgb_at(image, x + kPeriod, y).x - here));
            repeats = std::max(
                repeats, std::abs(rgb_at(image, y, x + kPeriod).x - rgb_at(image, y, x).x));
            range = {std::min(range.x, here), std::max(range.y, here)};
        }
        CHECK(repeats < 0.02f);
        const float darkest = pattern == ClothPattern::Plaid ? 0.4f : 0.0f;  // wide on wide lines
        CHECK(range.x < darkest + 0.01f);
        CHECK(range.y > 0.99f);
    }
}

TEST_CASE_FIXTURE(
    DressScene, "dress: light found at vertices or facets is colored as that of pixels is"
                    * technique("engine.multi-material, light.gouraud")) {
    constexpr int kSize = 32;
    shine(DirectionalLight{.illuminance = 2}, look_at({0, 0, 0}, {0.4f, -0.3f, -1}));
    Material plain = {.shading = ShadingModel::Phong, .base_color = {1, 1, 1, 1}};
    plain.specular = Vec3(0);
    Material dressed = plain;
    dressed.dress = with_shirt(ClothPattern::Checks, 0.5f);
    dressed.dress.shirt.color = {0.2f, 0.5f, 0.9f};
    dressed.dress.shirt.ink = {0.8f, 0.1f, 0.3f};
    const MeshId cloth = add(make_cloth(alpha_of_part(DressedPart::Shirt)));
    const auto seen = [&](const Material& material, ShadingRate rate) {
        world.insert_resource(Rendering{.lights = LightMethod::ObjectMajor, .shading = rate});
        const Entity square = place(cloth, add(material), Affine{});
        gpu::FloatImage image = radiance(look({0, 0, 1}, {0, 0, 0}, kSize, kSize));
        world.destroy(square);
        return image;
    };
    const gpu::FloatImage pixels = seen(dressed, ShadingRate::Pixel);
    const gpu::FloatImage white_pixels = seen(plain, ShadingRate::Pixel);
    CHECK(largest_difference(pixels, white_pixels) > 0.1f);
    for (int i = 1; i < kShadingRates; ++i) {
        CAPTURE(i);
        const auto rate = static_cast<ShadingRate>(i);
        const gpu::FloatImage colored = seen(dressed, rate);
        const gpu::FloatImage white = seen(plain, rate);
        float worst = 0;
        for (int k = 0; k < kSize * kSize; ++k) {
            const Vec3 factor =
                rgb_at(pixels, k % kSize, k / kSize) / rgb_at(white_pixels, k % kSize, k / kSize);
            const Vec3 other = factor * rgb_at(white, k % kSize, k / kSize);
            const Vec3 off = glm::abs(rgb_at(colored, k % kSize, k / kSize) - other);
            worst = std::max({worst, off.x, off.y, off.z});
        }
        CHECK(worst < 4e-3f);
    }
}

TEST_CASE_FIXTURE(DressScene, "dress: far away, every pattern is the mean of what it is near") {
    constexpr int kSize = 64;
    for (int i = 0; i <= static_cast<int>(ClothPattern::Twill); ++i) {
        const Dress dress = with_shirt(static_cast<ClothPattern>(i), 0.05f);
        const float close = mean_of(shirt(dress, 0.05f * 4, kSize), kSize);
        const gpu::FloatImage far = shirt(dress, 0.05f * 400, kSize);
        CAPTURE(i);
        CHECK(double(mean_of(far, kSize)) == near(double(close)).epsilon(0.02));
        float spread = 0;
        for (int x = 0; x < kSize; ++x) {
            spread = std::max(spread, std::abs(rgb_at(far, x, 20).x - close));
        }
        CHECK(spread < 0.1f);
        CHECK((i == 0 ? close == 1 : close < 0.9f));
    }
}

TEST_CASE_FIXTURE(
    DressScene, "dress: people of one mesh in different dresses are one draw"
                    * technique("engine.batching, engine.multi-material")) {
    const MeshId mesh = add(make_cloth(alpha_of_part(DressedPart::Shirt)));
    for (int i = 0; i < 30; ++i) {
        Dress dress = with_shirt(static_cast<ClothPattern>(i % 8), 0.05f);
        dress.hair = Vec3(0.5f + 0.01f * static_cast<float>(i));
        place(
            mesh, add(make_dressed(dress)),
            affine_from({0.05f * static_cast<float>(i) - 0.7f, 0, 0}, {1, 0, 0, 0}, Vec3(0.02f)));
    }
    const FrameOutput out = draw(look({0, 0, 1.2f}, {0, 0, 0}, 64, 64));
    CHECK(out.statistics.visible_instances == 30);
    CHECK(out.statistics.draws == 1);
}

}  // namespace limn::test::dress_test
