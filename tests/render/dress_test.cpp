// Colors and patterns of persons in one mesh, by the alpha of their vertex colors.

#include "ecs/components/dress.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

/// 1 - the ink of stripes, bands and checks at a point, in periods.
float plain_cloth(ClothPattern pattern, float u, float v) {
    const float across = u - std::floor(u) < 0.5f ? 1.0f : 0.0f;
    const float along = v - std::floor(v) < 0.5f ? 1.0f : 0.0f;
    return 1
           - (pattern == ClothPattern::Stripes ? across
              : pattern == ClothPattern::Bands ? along
                                               : 0.5f * (across + along));
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
    constexpr int kSamples = 32;
    for (const ClothPattern pattern :
         {ClothPattern::Stripes, ClothPattern::Bands, ClothPattern::Checks}) {
        const gpu::FloatImage image = shirt(with_shirt(pattern, 0.05f), 0.05f * kPeriods, kSize);
        float worst = 0;
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                float sum = 0;
                for (int i = 0; i < kSamples * kSamples; ++i) {
                    const float u = (float(x) + (float(i % kSamples) + 0.5f) / kSamples) / kSize;
                    const float v = (float(y) + (float(i / kSamples) + 0.5f) / kSamples) / kSize;
                    sum += plain_cloth(pattern, kPeriods * u, kPeriods * v);
                }
                const float other = sum / (kSamples * kSamples);
                worst = std::max(worst, std::abs(rgb_at(image, x, y).x - other));
            }
        }
        CAPTURE(static_cast<int>(pattern));
        CHECK(worst < 0.02f);
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
