#include "bench/oracles/sampling_forms.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::test::sampling_test {
namespace {

using oracle::SampledShape;
using oracle::SamplingForm;

constexpr int kSize = 8;
constexpr SampledShape kShapes[] = {
    SampledShape::Line, SampledShape::Plane, SampledShape::Rectangle, SampledShape::Volume,
    SampledShape::Cube};

const SamplingForm& form_named(const std::string& name) {
    for (const SamplingForm& form : oracle::sampling_forms()) {
        if (form.name == name) {
            return form;
        }
    }
    FAIL("no form " << name);
    return oracle::sampling_forms()[0];
}

gpu::Sampler nearest_sampler(const SamplingForm& form) {
    const bool levels = form.shape != SampledShape::Rectangle;
    return gpu::Sampler(
        "sampled", {.minify = static_cast<GLenum>(levels ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST),
                    .magnify = GL_NEAREST,
                    .wrap = static_cast<GLenum>(levels ? GL_REPEAT : GL_CLAMP_TO_EDGE),
                    .compare = static_cast<GLenum>(form.compares ? GL_LEQUAL : GL_NONE)});
}

/// Of the nearest texel.
std::vector<Vec4> sampled(const SamplingForm& form, const std::vector<Vec4>& points) {
    const oracle::TexelPyramid texels = oracle::noise_texels(form.shape, kSize);
    const gpu::Texture texture = make_sampled_texture(form.shape, texels, form.compares);
    const auto found =
        oracle::sample_on_gpu(shared_device(), form, texture, nearest_sampler(form), points);
    REQUIRE_MESSAGE(found.ok(), (found ? "" : found.error().message));
    return *found;
}

/// Points at the centers of texels, also beyond the edges of what repeats, in coordinates of the
/// shape; r is a reference, too.
std::vector<Vec4> centers(SampledShape shape) {
    std::vector<Vec4> points;
    for (int i = 0; i < 96; ++i) {
        Vec3 texel = {
            static_cast<float>(i % 24 - 8) + 0.5f, static_cast<float>(5 * i % 24 - 8) + 0.5f,
            static_cast<float>(7 * i % 24 - 8) + 0.5f};
        if (shape == SampledShape::Cube) {
            texel[i % 3] = i % 2 == 0 ? 20.0f : -20.0f;
        } else if (shape != SampledShape::Rectangle) {
            texel /= static_cast<float>(kSize);
        }
        points.emplace_back(texel, 1);
    }
    return points;
}

}  // namespace

TEST_CASE("sampling: there are 24 functions, each by itself" * technique("tex.sampling")) {
    const auto forms = oracle::sampling_forms();
    CHECK(forms.size() == 24);
    const auto count = [&](SampledShape shape) {
        return std::count_if(forms.begin(), forms.end(), [&](const SamplingForm& form) {
            return form.shape == shape;
        });
    };
    constexpr std::array<int, 5> kCounts = {6, 6, 6, 3, 3};
    for (std::size_t i = 0; i < kCounts.size(); ++i) {
        CHECK(count(kShapes[i]) == kCounts[i]);
    }
    for (std::size_t i = 0; i < forms.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            CHECK(std::string(forms[i].name) != forms[k].name);
            CHECK(
                std::string(forms[i].sampler) + forms[i].call
                != std::string(forms[k].sampler) + forms[k].call);
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "sampling: every function reads the texel that it reads in double precision"
                    * technique("tex.sampling")) {
    for (const SamplingForm& form : oracle::sampling_forms()) {
        CAPTURE(form.name);
        const std::vector<Vec4> points = centers(form.shape);
        const std::vector<Vec4> found = sampled(form, points);
        const oracle::TexelPyramid texels = oracle::noise_texels(form.shape, kSize);
        const Wrap wrap = form.shape == SampledShape::Rectangle ? Wrap::Clamp : Wrap::Repeat;
        std::size_t wrong = 0;
        std::size_t bright = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec4 exact(oracle::sample_exactly(
                form, texels,
                {.wrap_u = wrap,
                 .wrap_v = wrap,
                 .nearest = true,
                 .minify = Minify::NearestMipNearest},
                points[i]));
            wrong += found[i] != exact ? 1 : 0;
            bright += found[i].x > 0.5f ? 1 : 0;
        }
        CHECK(wrong == 0);
        CHECK(bright > 5);
        CHECK(bright < points.size());
    }
}

TEST_CASE_FIXTURE(
    RenderTest,
    "sampling: a projected lookup at (s q, q) is the plain one at s" * technique("tex.sampling")) {
    for (const SamplingForm& form : oracle::sampling_forms()) {
        if (!form.projects) {
            continue;
        }
        CAPTURE(form.name);
        const std::string name = form.name;
        const std::size_t word = name.find(", projected");
        const std::vector<Vec4> plain = centers(form.shape);
        const std::vector<Vec4> expected =
            sampled(form_named(name.substr(0, word) + name.substr(word + 11)), plain);
        for (const float q : {0.25f, 4.0f, -2.0f}) {
            if (form.shape == SampledShape::Cube && q < 0) {
                continue;  // the opposite direction
            }
            std::vector<Vec4> projected;
            for (const Vec4& point : plain) {
                projected.push_back(q * point);
            }
            CHECK(sampled(form, projected) == expected);
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest,
    "sampling: a rectangle at (i + 1/2, j + 1/2) is its texel (i, j)" * technique("tex.sampling")) {
    std::vector<Vec4> points;
    for (int i = 0; i < kSize * kSize; ++i) {
        points.emplace_back(
            static_cast<float>(i % kSize) + 0.5f, static_cast<float>(i / kSize) + 0.5f, 0, 1);
    }
    const std::vector<Vec4> found = sampled(form_named("rectangle"), points);
    const oracle::TexelPyramid texels = oracle::noise_texels(SampledShape::Rectangle, kSize);
    REQUIRE(found.size() == texels.levels[0].texels.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(found[i] == Vec4(texels.levels[0].texels[i]));
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "sampling: a comparison with the nearest texel is 0 or 1, and both occur"
                    * technique("tex.sampling")) {
    for (const SamplingForm& form : oracle::sampling_forms()) {
        if (!form.compares) {
            continue;
        }
        CAPTURE(form.name);
        std::vector<Vec4> points = centers(form.shape);
        for (std::size_t i = 0; i < points.size(); ++i) {
            points[i].z = static_cast<float>(i) / static_cast<float>(points.size());
        }
        std::array<int, 2> counts = {};
        for (const Vec4& value : sampled(form, points)) {
            REQUIRE((value.x == 0 || value.x == 1));
            ++counts[value.x == 1 ? 1 : 0];
        }
        CHECK(counts[0] > 5);
        CHECK(counts[1] > 5);
    }
}

namespace {

/// The square of side 2, which fills the image, with 8 x 8 texels of a hash.
struct SampledPlate : Scene {
    MaterialId material = add(Material{});
    oracle::TexelPyramid texels = oracle::noise_texels(SampledShape::Plane, kSize);
    ImageId image;

    SampledPlate() {
        place(add(make_square()), material, at({0, 0, 0}));
        ImageData data = {
            .name = "noise",
            .width = kSize,
            .height = kSize,
            .format = PixelFormat::Rgba32F,
            .pixels = {}};
        for (const glm::dvec4& texel : texels.levels[0].texels) {
            const Vec4 value(texel);
            const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&value);
            data.pixels.insert(data.pixels.end(), bytes, bytes + sizeof(Vec4));
        }
        image = add(std::move(data));
    }

    gpu::FloatImage with(const TextureSlot& slot, int size) {
        Assets& assets = world.resource<Assets>();
        assets.materials[material.index] = {
            .shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}, .base_color_texture = slot};
        assets.materials[material.index].base_color_texture.image = image;
        ++assets.material_version;
        return radiance(look({0, 0, 1}, {0, 0, 0}, size, size));
    }

    /// How far the plate is from the lookups of its pixels' centers, and how far they are apart.
    struct Difference {
        double largest = 0;
        double contrast = 0;
    };
    Difference difference(const TextureSlot& slot, int size) {
        const gpu::FloatImage found = with(slot, size);
        const oracle::SamplerRules rules = {
            .wrap_u = slot.wrap_u,
            .wrap_v = slot.wrap_v,
            .nearest = slot.nearest,
            .minify = slot.minify,
            .bias = slot.lod_bias,
            .range = glm::dvec2(slot.lod_range)};
        const double step = static_cast<double>(slot.scale.x) / size;
        Difference difference;
        double lowest = 1;
        double highest = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const glm::dvec3 uvw = {
                    (x + 0.5) * step + static_cast<double>(slot.offset.x),
                    (y + 0.5) * step + static_cast<double>(slot.offset.y), 0.5};
                const double exact =
                    sample_texture(
                        texels, rules, uvw,
                        oracle::level_of_detail({step * kSize, 0}, {0, step * kSize}))
                        .x;
                difference.largest = std::max(
                    difference.largest, std::abs(exact - static_cast<double>(found.at(x, y, 0))));
                lowest = std::min(lowest, exact);
                highest = std::max(highest, exact);
            }
        }
        difference.contrast = highest - lowest;
        return difference;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    SampledPlate, "sampling: maps of materials are filtered and wrapped as their slots say"
                      * technique("tex.sampling")) {
    struct Options {
        std::string name;
        TextureSlot slot;
    };
    std::vector<Options> all = {
        {"nearest", {.image = {}, .nearest = true, .minify = Minify::Nearest}},
        {"linear", {.image = {}, .minify = Minify::Linear}},
        {"one texel of a level", {.image = {}, .minify = Minify::NearestMipNearest}},
        {"four texels of a level", {.image = {}, .minify = Minify::LinearMipNearest}},
        {"a texel of two levels", {.image = {}, .minify = Minify::NearestMipLinear}},
        {"trilinear", {.image = {}, .minify = Minify::LinearMipLinear}},
        {"sharper", {.image = {}, .minify = Minify::LinearMipNearest, .lod_bias = -1.25f}},
        {"blurred", {.image = {}, .minify = Minify::LinearMipNearest, .lod_bias = 1}},
        {"level 1", {.image = {}, .minify = Minify::LinearMipNearest, .lod_range = {1, 1}}},
        {"mirrored",
         {.image = {},
          .wrap_u = Wrap::Mirror,
          .wrap_v = Wrap::Clamp,
          .minify = Minify::NearestMipNearest}}};
    for (Options& one : all) {
        CAPTURE(one.name);
        for (const float scale : {1.0f, 4.2f}) {
            CAPTURE(scale);
            one.slot.scale = Vec2(scale);
            one.slot.offset = {0.013f, 0.017f};  // texel centers are not at pixels' corners
            const Difference found = difference(one.slot, 16);
            // Emission has a mantissa of nine bits; hardware filters with weights of 8 bits.
            CHECK(found.largest < (device().caps().software ? 4e-3 : 3.0 / 256));
            CHECK(found.contrast > 0.05);
        }
    }
}

TEST_CASE_FIXTURE(
    SampledPlate,
    "sampling: the last level alone is the mean of the image" * technique("tex.sampling")) {
    const gpu::FloatImage drawn =
        with({.image = {}, .minify = Minify::LinearMipLinear, .lod_range = {3, 3}}, 16);
    for (int x = 0; x < 16; ++x) {
        CHECK(
            static_cast<double>(drawn.at(x, 7, 0))
            == near(texels.levels[3].texels[0].x).epsilon(4e-3));
    }
}

TEST_CASE_FIXTURE(
    SampledPlate,
    "sampling: with anisotropy a slanted plate keeps the contrast along its narrow axis"
        * technique("tex.sampling")) {
    if (device().caps().max_anisotropy < 4) {
        MESSAGE("skipped: no anisotropic filtering");
        return;
    }
    // Stripes of two texels along v, in pixels that see eight times as much of v as of u.
    auto& pixels = world.resource<Assets>().images[image.index].pixels;
    for (int i = 0; i < kSize * kSize; ++i) {
        const Vec4 value(i % kSize / 2 % 2 == 0 ? Vec3(0) : Vec3(1), 1);
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&value);
        std::copy(bytes, bytes + sizeof(Vec4), pixels.begin() + i * static_cast<int>(sizeof(Vec4)));
    }
    const auto contrast = [&](float anisotropy) {
        const gpu::FloatImage found = with(
            {.image = {},
             .minify = Minify::LinearMipLinear,
             .scale = {2, 16},
             .anisotropy = anisotropy},
            16);
        float lowest = 1;
        float highest = 0;
        for (int x = 0; x < 16; ++x) {
            lowest = std::min(lowest, found.at(x, 8, 0));
            highest = std::max(highest, found.at(x, 8, 0));
        }
        return highest - lowest;
    };
    CHECK(contrast(1) < 0.05f);
    CHECK(contrast(16) > 0.5f);
}

}  // namespace limn::test::sampling_test
