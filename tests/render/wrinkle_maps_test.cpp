#include "ecs/components/time.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/components/wrinkle_response.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace limn::test::wrinkle_maps_test {
namespace {

using DVec2 = glm::dvec2;
using DVec3 = glm::dvec3;

constexpr int kSide = 16;
constexpr double kRounding = 1.74 / 255;  // half a step of 8 bits in each coordinate of a normal
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

template <typename Texel>
ImageData painted(Texel&& texel) {
    ImageData image;
    image.name = "painted";
    image.width = image.height = kSide;
    image.format = PixelFormat::Rgba32F;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const Vec4 value = texel(x, y);
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
            image.pixels.insert(image.pixels.end(), bytes, bytes + sizeof(value));
        }
    }
    return image;
}

/// An image of normals that point up, different for each `kind`.
Vec4 normal_texel(int kind, int x, int y) {
    const auto phase = static_cast<float>(kind);
    const Vec2 slope = {
        0.9f * std::sin(0.7f * static_cast<float>(x) + phase),
        0.8f * std::cos(0.5f * static_cast<float>(y) - 2 * phase)};
    return {0.5f + 0.5f * glm::normalize(Vec3(slope, 1)), 1};
}

/// Four regions that overlap in the central column.
Vec4 mask_texel(int kind, int x, int y) {
    const float s = (static_cast<float>(x) + 0.5f) / kSide;
    const float t = (static_cast<float>(y) + 0.5f) / kSide;
    return kind == 0   ? Vec4(s, 1 - s, t, 0.5f)
           : kind == 1 ? Vec4(0.25f, t * s, 0.75f * s, 1 - t)
                       : Vec4(0.6f * t, 0, 0, 0);
}

DVec3 decoded(const Vec4& texel) {
    return 2.0 * DVec3(texel) - 1.0;
}

DVec3 add_normals(const DVec3& n, const DVec3& w) {
    return glm::normalize(DVec3(n.x + w.x, n.y + w.y, n.z * w.z));
}

/// Listings 1 and 2 of Oat 2007, in double precision.
DVec3 composed(const WrinkleWeights& weights, WrinkleBlend blend, int x, int y) {
    DVec2 influence = {0, 0};
    for (std::size_t i = 0; i < kWrinkleRegions.size(); ++i) {
        const double mask = mask_texel(static_cast<int>(i / 4), x, y)[static_cast<int>(i % 4)];
        const double weight = weights.*kWrinkleRegions[i];
        influence += mask * DVec2(std::max(-weight, 0.0), std::max(weight, 0.0));
    }
    influence = glm::min(influence, DVec2(1));
    const DVec3 n = decoded(normal_texel(0, x, y));
    const DVec3 stretched = decoded(normal_texel(1, x, y));
    const DVec3 compressed = decoded(normal_texel(2, x, y));
    if (blend == WrinkleBlend::Slopes) {
        const DVec2 slope = DVec2(n) / n.z + influence.x * DVec2(stretched) / stretched.z
                            + influence.y * DVec2(compressed) / compressed.z;
        return glm::normalize(DVec3(slope, 1));
    }
    const DVec3 w = glm::mix(DVec3(0, 0, 1), stretched, influence.x);
    return add_normals(n, glm::mix(w, compressed, influence.y));
}

/// A square that shows every texel of the target.
class WrinkledFace : public Scene {
  public:
    WrinkledFace() {
        world.insert_resource(Exposure{});
        world.insert_resource(FrameTime{.step = 1.0f / 60});
        const auto normals = [&](int kind) {
            return add(painted([kind](int x, int y) { return normal_texel(kind, x, y); }));
        };
        const auto masks = [&](int kind) {
            return add(painted([kind](int x, int y) { return mask_texel(kind, x, y); }));
        };
        maps.base = normals(0);
        maps.stretched = normals(1);
        maps.compressed = normals(2);
        maps.first_masks = masks(0);
        maps.second_masks = masks(1);
        maps.third_masks = masks(2);
        maps.target = add(painted([](int, int) { return Vec4(0, 0, 0, 1); }));
        Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        material.base_color_texture.image = maps.target;
        material.base_color_texture.nearest = true;
        place(add(make_square()), add(material), at({0, 0, 0}));
        face = world.create(maps, WrinkleWeights{});
    }
    gpu::FloatImage rendered() {
        return radiance(look({0, 0, 1}, {0, 0, 0}, kZoom * kSide, kZoom * kSide));
    }
    gpu::FloatImage rendered(const WrinkleWeights& weights) {
        world.get<WrinkleWeights>(face) = weights;
        return rendered();
    }
    /// Normal of a texel.
    static DVec3 normal(const gpu::FloatImage& image, int x, int y) {
        return 2.0 * DVec3(rgb_at(image, kZoom * x + kZoom / 2, kZoom * y + kZoom / 2)) - 1.0;
    }
    template <typename Expected>
    static double largest_error(const gpu::FloatImage& image, Expected&& expected) {
        double largest = 0;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const DVec3 difference = normal(image, x, y) - expected(x, y);
                largest = std::max(largest, glm::length(difference));
            }
        }
        return largest;
    }

    static constexpr int kZoom = 4;  // pixels a texel
    WrinkleMaps maps;
    Entity face;
};

constexpr WrinkleWeights kGrimace = {
    .left_brow = 0.6f,
    .right_brow = -0.4f,
    .middle_brow = 0.1f,
    .lips = -0.3f,
    .left_cheek = 1,
    .right_cheek = -1,
    .upper_left_cheek = 0.35f,
    .upper_right_cheek = -0.25f,
    .chin = 0.45f};

WrinkleWeights scaled(const WrinkleWeights& weights, float factor) {
    WrinkleWeights result;
    for (float WrinkleWeights::*const region : kWrinkleRegions) {
        result.*region = factor * weights.*region;
    }
    return result;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest,
    "wrinkle maps: composites are those of double precision to 1e-6"
        * technique("wrinkle.maps.composite, wrinkle.maps.influence, wrinkle.maps.normal-add")) {
    const auto halves = [](const WrinkleWeights& weights, std::size_t first) {
        Vec4 four;
        for (std::size_t i = 0; i < 4; ++i) {
            four[static_cast<int>(i)] = weights.*kWrinkleRegions[first + i];
        }
        return four;
    };
    for (const WrinkleBlend blend : {WrinkleBlend::Lerp, WrinkleBlend::Slopes}) {
        for (const float factor : {1.0f, -1.0f, 0.5f, 0.05f}) {
            const WrinkleWeights weights = scaled(kGrimace, factor);
            std::vector<Vec4> inputs;
            for (int i = 0; i < kSide * kSide; ++i) {
                const int x = i % kSide;
                const int y = i / kSide;
                inputs.insert(
                    inputs.end(),
                    {mask_texel(0, x, y), mask_texel(1, x, y), halves(weights, 0),
                     halves(weights, 4), Vec4(mask_texel(2, x, y).x, weights.chin, 0, 0)});
                for (const int kind : {0, 1, 2}) {
                    inputs.emplace_back(Vec3(decoded(normal_texel(kind, x, y))), 0.0f);
                }
            }
            const std::string compose =
                blend == WrinkleBlend::Lerp ? "compose_by_lerp" : "compose_by_slopes";
            const std::vector<Vec4> found = evaluate_shader(
                "#include \"lib/wrinkle_maps.glsl\"",
                "uint k = i / 8u * 8u;\n"
                "vec2 f = wrinkle_influence(inputs[k], inputs[k + 1u], inputs[k + 4u].x, "
                "inputs[k + 2u], inputs[k + 3u], inputs[k + 4u].y);\n"
                "y.xyz = "
                    + compose + "(inputs[k + 5u].xyz, inputs[k + 6u].xyz, inputs[k + 7u].xyz, f);",
                inputs);
            double largest = 0;
            for (int i = 0; i < kSide * kSide; ++i) {
                const DVec3 expected = composed(weights, blend, i % kSide, i / kSide);
                const DVec3 at = Vec3(found[8 * static_cast<std::size_t>(i)]);
                largest = std::max(largest, glm::length(at - expected));
            }
            CHECK(largest <= 1e-6);
        }
    }
}

TEST_CASE_FIXTURE(
    WrinkledFace, "wrinkle maps: the image shows the composite of every texel"
                      * technique("wrinkle.maps.composite")) {
    for (const WrinkleBlend blend : {WrinkleBlend::Lerp, WrinkleBlend::Slopes}) {
        world.get<WrinkleMaps>(face).blend = blend;
        for (const float factor : {1.0f, -1.0f, 0.05f}) {
            const WrinkleWeights weights = scaled(kGrimace, factor);
            const double error = largest_error(
                rendered(weights), [&](int x, int y) { return composed(weights, blend, x, y); });
            CHECK(error <= kRounding);
        }
    }
}

TEST_CASE_FIXTURE(
    WrinkledFace, "skin pipeline: measured weights draw the same as the animator's, pixel for pixel"
                      * technique("skin.pipeline")) {
    const gpu::FloatImage animated = rendered(kGrimace);
    const gpu::FloatImage rest = rendered({});
    world.add(face, WrinkleResponse{.share = 1});
    world.add(face, MeasuredWrinkles{.weights = kGrimace, .started = true});
    CHECK(rendered({.lips = 1}).pixels == animated.pixels);
    // With a `share` of 0 the skin is drawn as at rest: wrinkles are left to the surface.
    world.get<WrinkleResponse>(face).share = 0;
    CHECK(rendered({.lips = 1}).pixels == rest.pixels);
    // Half of it is half of the influence.
    world.get<WrinkleResponse>(face).share = 0.5f;
    world.get<MeasuredWrinkles>(face).weights = {.left_brow = 1};
    const gpu::FloatImage half = rendered({});
    world.remove<WrinkleResponse>(face);
    CHECK(half.pixels == rendered({.left_brow = 0.5f}).pixels);
}

TEST_CASE_FIXTURE(
    WrinkledFace, "wrinkle maps: without weights normals are those of the skin"
                      * technique("wrinkle.maps.composite, wrinkle.maps.weights")) {
    const auto skin = [](int x, int y) { return decoded(normal_texel(0, x, y)); };
    CHECK(largest_error(rendered({}), skin) <= kRounding);
    CHECK(largest_error(rendered({.left_brow = kNaN, .lips = kNaN}), skin) <= kRounding);
    world.remove<WrinkleWeights>(face);
    CHECK(largest_error(rendered(), skin) <= kRounding);
}

TEST_CASE_FIXTURE(
    WrinkledFace,
    "wrinkle maps: weights beyond -1 and 1 count as those" * technique("wrinkle.maps.weights")) {
    const gpu::FloatImage full = rendered(scaled(kGrimace, 0));
    const gpu::FloatImage beyond = rendered({.left_brow = 10, .right_brow = -10});
    const gpu::FloatImage most = rendered({.left_brow = 1, .right_brow = -1});
    CHECK(beyond.pixels == most.pixels);
    CHECK(beyond.pixels != full.pixels);
}

TEST_CASE_FIXTURE(
    WrinkledFace, "wrinkle maps: a preset is drawn as the weights that it stands for"
                      * technique("wrinkle.maps.animation")) {
    CHECK(
        rendered({.preset = WrinklePreset::Sour}).pixels
        == rendered({WrinklePreset::Neutral, 1, 1, 1, 1, 1, 1, 1, 1, 1}).pixels);
    CHECK(
        rendered({.preset = WrinklePreset::Surprised, .lips = 0.75f}).pixels
        == rendered({WrinklePreset::Neutral, -1, -1, -1, -0.25f, -1, -1, -1, -1, -1}).pixels);
}

TEST_CASE_FIXTURE(
    WrinkledFace, "wrinkle maps: overlapping regions act at most as one with full weight"
                      * technique("wrinkle.maps.influence")) {
    // First masks are s and 1 - s: together 1 everywhere, with the lips' 0.5 beyond.
    const gpu::FloatImage one = rendered({.left_brow = 1, .right_brow = 1});
    const gpu::FloatImage more = rendered({.left_brow = 1, .right_brow = 1, .lips = 1});
    CHECK(one.pixels == more.pixels);
    const auto added = [](int x, int y) {
        return add_normals(decoded(normal_texel(0, x, y)), decoded(normal_texel(2, x, y)));
    };
    CHECK(largest_error(one, added) <= kRounding);
}

TEST_CASE_FIXTURE(
    WrinkledFace,
    "wrinkle maps: opposite weights swap both maps" * technique("wrinkle.maps.influence")) {
    maps = world.get<WrinkleMaps>(face);
    const WrinkleWeights surprised = {.left_brow = -0.7f, .lips = -0.2f, .left_cheek = -0.5f};
    const gpu::FloatImage stretched = rendered(surprised);
    std::swap(maps.stretched, maps.compressed);
    world.get<WrinkleMaps>(face) = maps;
    CHECK(largest_difference(stretched, rendered(scaled(surprised, -1))) == 0.0f);
}

TEST_CASE_FIXTURE(
    WrinkledFace,
    "wrinkle maps: a compressed map at full weight covers the stretched one, slopes add up"
        * technique("wrinkle.maps.composite")) {
    // The cheeks' masks are below 1: only brows act in full.
    WrinkleWeights both = {.left_brow = 1, .right_brow = 1, .left_cheek = -1};
    const WrinkleWeights compressed = {.left_brow = 1, .right_brow = 1};
    CHECK(rendered(both).pixels == rendered(compressed).pixels);
    world.get<WrinkleMaps>(face).blend = WrinkleBlend::Slopes;
    CHECK(largest_difference(rendered(both), rendered(compressed)) > 0.01f);
}

TEST_CASE_FIXTURE(
    WrinkledFace, "wrinkle maps: without second masks the lower regions have no effect"
                      * technique("wrinkle.maps.masks")) {
    world.get<WrinkleMaps>(face).second_masks = {};
    CHECK(rendered({.lips = 0.4f, .left_cheek = 1}).pixels == rendered({.lips = 0.4f}).pixels);
    CHECK(rendered({.chin = 1}).pixels != rendered({}).pixels);
    world.get<WrinkleMaps>(face).third_masks = {};
    CHECK(rendered({.chin = 1}).pixels == rendered({}).pixels);
}

TEST_CASE_FIXTURE(
    WrinkledFace, "wrinkle maps: a weight changes no pixel outside its mask, whatever the others"
                      * technique("wrinkle.maps.masks")) {
    // A chin in the lower half of its mask.
    world.get<WrinkleMaps>(face).third_masks =
        add(painted([](int, int y) { return Vec4(y >= kSide / 2 ? 1 : 0, 0, 0, 0); }));
    const WrinkleWeights others = {.left_brow = 0.3f, .lips = -0.4f, .upper_left_cheek = 0.2f};
    for (const float chin : {-1.0f, 0.2f, 1.0f}) {
        WrinkleWeights changed = others;
        changed.chin = chin;
        const gpu::FloatImage without = rendered(others);
        const gpu::FloatImage with = rendered(changed);
        int different = 0;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const bool same = normal(with, x, y) == normal(without, x, y);
                different += same ? 0 : 1;
                CHECK((same || y >= kSide / 2));
            }
        }
        CHECK(different == kSide * kSide / 2);
    }
}

TEST_CASE_FIXTURE(
    WrinkledFace,
    "wrinkle maps: without an image, or if they read their own target, nothing is drawn"
        * technique("wrinkle.maps.texture-set")) {
    const WrinkleMaps good = maps;
    ImageId WrinkleMaps::*const needed[] = {
        &WrinkleMaps::base, &WrinkleMaps::stretched, &WrinkleMaps::compressed,
        &WrinkleMaps::first_masks};
    for (ImageId WrinkleMaps::*const image : needed) {
        WrinkleMaps bad = good;
        bad.*image = {77};
        world.get<WrinkleMaps>(face) = bad;
        CHECK(rgb_at(rendered(kGrimace), 5, 5) == Vec3(0));
        bad.*image = good.target;
        world.get<WrinkleMaps>(face) = bad;
        CHECK(rgb_at(rendered(kGrimace), 5, 5) == Vec3(0));
    }
    world.get<WrinkleMaps>(face) = good;
    CHECK(rgb_at(rendered(kGrimace), 5, 5) != Vec3(0));
}

TEST_CASE_FIXTURE(
    WrinkledFace,
    "wrinkle maps: an image of another aspect ratio is rejected, of another size accepted"
        * technique("wrinkle.maps.texture-set")) {
    const WrinkleMaps good = maps;
    const auto flat = [&](int width, int height) {
        const auto texels = static_cast<std::size_t>(width * height);
        return add(ImageData{
            .name = "flat",
            .width = width,
            .height = height,
            .pixels = std::vector<std::uint8_t>(4 * texels, 128)});
    };
    ImageId WrinkleMaps::*const all[] = {&WrinkleMaps::base,         &WrinkleMaps::stretched,
                                         &WrinkleMaps::compressed,   &WrinkleMaps::first_masks,
                                         &WrinkleMaps::second_masks, &WrinkleMaps::third_masks};
    const ImageData& target = world.resource<Assets>().images[good.target.index];
    const int width = target.width;
    const int height = target.height;
    for (ImageId WrinkleMaps::*const image : all) {
        WrinkleMaps changed = good;
        changed.*image = flat(2 * width, height);
        world.get<WrinkleMaps>(face) = changed;
        CHECK(rgb_at(rendered(kGrimace), 5, 5) == Vec3(0));
    }
    WrinkleMaps larger = good;
    larger.stretched = flat(2 * width, 2 * height);
    world.get<WrinkleMaps>(face) = larger;
    CHECK(rgb_at(rendered(kGrimace), 5, 5) != Vec3(0));
}

TEST_CASE_FIXTURE(
    WrinkledFace, "wrinkle maps: examples of normals that are added"
                      * technique("wrinkle.maps.composite, wrinkle.maps.normal-add")) {
    // A face whose normals are the same everywhere.
    const auto flat = [&](const Vec3& n) {
        return add(painted([n](int, int) { return Vec4(0.5f + 0.5f * n, 1); }));
    };
    const auto mask = add(painted([](int, int) { return Vec4(1, 0, 0, 0); }));
    const auto shown = [&](const Vec3& n, const Vec3& w1, const Vec3& w2, float weight) {
        world.get<WrinkleMaps>(face) = {flat(n), flat(w1), flat(w2), mask, {}, {}, maps.target};
        return normal(rendered({.left_brow = weight}), 3, 3);
    };
    const Vec3 up = {0, 0, 1};
    const Vec3 right = {0.6f, 0, 0.8f};
    const Vec3 front = {0, 0.6f, 0.8f};
    const auto is_near = [](const DVec3& found, const DVec3& expected) {
        CHECK(glm::length(found - expected) <= kRounding);
    };
    is_near(shown(right, up, front, 1), {0.564532, 0.564532, 0.602168});
    is_near(shown(front, right, up, -1), {0.564532, 0.564532, 0.602168});  // in either order
    is_near(shown(right, up, right, 1), {0.882353, 0, 0.470588});
    is_near(shown(right, up, up, 1), right);
    is_near(shown(up, up, front, 1), front);
    // A wrinkle of 53.13 degrees at a quarter, half and three quarters: flatter than its height.
    const float source[] = {12.529f, 26.565f, 40.601f};
    const float height[] = {18.435f, 33.690f, 45.000f};
    for (int i = 0; i < 3; ++i) {
        const Vec3 steep = {0.8f, 0, 0.6f};
        const float weight = 0.25f * static_cast<float>(i + 1);
        const DVec3 n = shown(up, up, steep, weight);
        CHECK(std::abs(std::atan2(n.x, n.z) - radians(source[i])) < kRounding);
        world.get<WrinkleMaps>(face).blend = WrinkleBlend::Slopes;
        const DVec3 exact = normal(rendered(), 3, 3);
        CHECK(std::abs(std::atan2(exact.x, exact.z) - radians(height[i])) < kRounding);
    }
}

}  // namespace limn::test::wrinkle_maps_test
