#include "bench/oracles/sampling_forms.h"
#include "bench/quality/quality_scene.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

// Techniques: tex.sampling

namespace limn::sampling_quality {
namespace {

using glm::dvec3;
using glm::dvec4;

constexpr int kTexels = 8;    ///< along an edge of a sampled texture
constexpr int kPoints = 512;  ///< of each form

/// 0 .. 1, of a low-discrepancy sequence.
double spread(int i, double step) {
    return std::fmod(step * (i + 1), 1.0);
}

/// A coordinate that is not within a hundredth of a texel's edge, in texels from -1 to 2 sizes.
double clear_of_edges(int i, double step) {
    const double texel = std::floor(3 * kTexels * spread(i, step)) - kTexels;
    return texel + 0.01 + 0.98 * spread(i, 1.7 * step);
}

std::vector<Vec4> points_of(const oracle::SamplingForm& form) {
    std::vector<Vec4> points;
    for (int i = 0; i < kPoints; ++i) {
        dvec3 at = {
            clear_of_edges(i, 0.7548776662), clear_of_edges(i, 0.5698402910),
            clear_of_edges(i, 0.6180339887)};
        if (form.shape == oracle::SampledShape::Cube) {
            // Of a face, where filters of level 1, of four texels, do not cross an edge.
            const dvec3 cell = 1.0 + glm::mod(glm::floor(at), 6.0);
            at = (cell + 0.5 + 0.9 * (glm::fract(at) - 0.5)) * 2.0 / 8.0 - 1.0;
            at[i % 3] = i % 2 == 0 ? 1 : -1;
            at *= 0.5 + spread(i, 0.33);
        } else if (form.shape != oracle::SampledShape::Rectangle) {
            at /= kTexels;
        }
        dvec4 x = {at, 1};
        if (form.compares) {
            x.z = spread(i, 0.4142135);
        }
        if (form.projects) {
            const double q = 0.25 + 3 * spread(i, 0.2360679);
            x *= form.shape != oracle::SampledShape::Cube && i % 2 == 1 ? -q : q;
        }
        points.emplace_back(x);
    }
    return points;
}

GLenum gl_minify(Minify minify) {
    constexpr std::array<GLenum, 7> kFilters = {
        GL_LINEAR_MIPMAP_LINEAR,
        GL_NEAREST,
        GL_LINEAR,
        GL_NEAREST_MIPMAP_NEAREST,
        GL_LINEAR_MIPMAP_NEAREST,
        GL_NEAREST_MIPMAP_LINEAR,
        GL_LINEAR_MIPMAP_LINEAR};
    return kFilters[static_cast<std::size_t>(minify)];
}

GLenum gl_wrap(Wrap wrap) {
    return wrap == Wrap::Repeat   ? GL_REPEAT
           : wrap == Wrap::Mirror ? GL_MIRRORED_REPEAT
                                  : GL_CLAMP_TO_EDGE;
}

gpu::SamplerDesc sampler_of(const oracle::SamplerRules& rules) {
    return {
        .minify = gl_minify(rules.minify),
        .magnify = static_cast<GLenum>(rules.nearest ? GL_NEAREST : GL_LINEAR),
        .wrap = gl_wrap(rules.wrap_u),
        .wrap_v = gl_wrap(rules.wrap_v),
        .lod_bias = static_cast<float>(rules.bias),
        .lod_range = Vec2(rules.range)};
}

double largest_difference(const Vec4& a, const dvec4& b) {
    const dvec4 difference = glm::abs(dvec4(a) - b);
    return std::max({difference.x, difference.y, difference.z, difference.w});
}

Result<double> largest_error(gpu::Device& device, const oracle::SamplingForm& form, bool linear) {
    const bool has_levels = form.shape != oracle::SampledShape::Rectangle;
    const Wrap wrap = has_levels ? Wrap::Repeat : Wrap::Clamp;
    const oracle::SamplerRules rules = {
        .wrap_u = wrap,
        .wrap_v = wrap,
        .nearest = !linear,
        .minify = !has_levels ? (linear ? Minify::Linear : Minify::Nearest)
                  : linear    ? Minify::LinearMipNearest
                              : Minify::NearestMipNearest};
    const oracle::TexelPyramid texels = oracle::noise_texels(form.shape, kTexels);
    const gpu::Texture texture = make_sampled_texture(form.shape, texels, form.compares);
    gpu::SamplerDesc desc = sampler_of(rules);
    desc.compare = static_cast<GLenum>(form.compares ? GL_LEQUAL : GL_NONE);
    const gpu::Sampler sampler("sampled", desc);
    const std::vector<Vec4> points = points_of(form);
    const std::vector<Vec4> found = LIMN_TRY(sample_on_gpu(device, form, texture, sampler, points));
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        largest = std::max(
            largest, largest_difference(found[i], sample_exactly(form, texels, rules, points[i])));
    }
    return largest;
}

Status measure_forms(gpu::Device& device, QualityReport& report) {
    for (const oracle::SamplingForm& form : oracle::sampling_forms()) {
        const double nearest = LIMN_TRY(largest_error(device, form, false));
        report.at_most(
            fmt::format("{}: nearest texel, largest difference", form.name), nearest, 1e-7);
        if (!form.compares) {
            // Hardware filters with weights of 8 bits.
            const double linear = LIMN_TRY(largest_error(device, form, true));
            report.at_most(
                fmt::format("{}: linear filter, largest difference", form.name), linear,
                device.caps().software ? 1e-5 : 3.0 / 256);
        }
    }
    return Done{};
}

struct FilterCase {
    const char* name;
    oracle::SamplerRules rules;
};

std::vector<FilterCase> filter_cases() {
    std::vector<FilterCase> cases = {
        {"nearest", {.minify = Minify::Nearest}},
        {"linear", {.minify = Minify::Linear}},
        {"nearest_mipmap_nearest", {.minify = Minify::NearestMipNearest}},
        {"linear_mipmap_nearest", {.minify = Minify::LinearMipNearest}},
        {"nearest_mipmap_linear", {.minify = Minify::NearestMipLinear}},
        {"linear_mipmap_linear", {.minify = Minify::LinearMipLinear}},
        {"mirrored and clamped", {.wrap_u = Wrap::Mirror, .wrap_v = Wrap::Clamp}},
        {"bias -1.5", {.bias = -1.5}},
        {"levels 1.5 to 2", {.range = {1.5, 2}}},
        {"level 2 alone", {.range = {2, 2}}}};
    cases[0].rules.nearest = true;
    return cases;
}

/// Points with derivatives of -1 .. 4 levels, not where a filter would switch to the next level,
/// nor where drivers disagree about which filter counts, between 0 and 1/2.
std::vector<Vec4> gradient_points(const oracle::SamplerRules& rules) {
    std::vector<Vec4> points;
    for (int i = 0; i < kPoints; ++i) {
        const bool along_x = i % 2 == 0;
        const double whole = std::floor(5 * spread(i, 0.33)) - 1;
        const double part = 0.1 + 0.3 * spread(i, 0.7548776662);
        const double level = whole - rules.bias + (i % 4 < 2 && whole != 0 ? part : -part);
        const auto step = static_cast<float>(std::exp2(level) / kTexels);
        points.emplace_back(
            clear_of_edges(i, 0.7548776662) / kTexels, clear_of_edges(i, 0.5698402910) / kTexels, 0,
            0);
        points.emplace_back(along_x ? step : 0, 0, along_x ? 0.3f * step : 0, along_x ? 0 : step);
    }
    return points;
}

Status measure_filters(gpu::Device& device, QualityReport& report) {
    const oracle::TexelPyramid texels = oracle::noise_texels(oracle::SampledShape::Plane, kTexels);
    const gpu::Texture texture = make_sampled_texture(oracle::SampledShape::Plane, texels, false);
    for (const FilterCase& one : filter_cases()) {
        const gpu::Sampler sampler("sampled", sampler_of(one.rules));
        const std::vector<Vec4> points = gradient_points(one.rules);
        const std::vector<Vec4> found =
            LIMN_TRY(oracle::sample_gradients_on_gpu(device, texture, sampler, points));
        double largest = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const glm::dvec4 point(points[2 * i]);
            const glm::dvec4 along = glm::dvec4(points[2 * i + 1]) * static_cast<double>(kTexels);
            const double level = oracle::level_of_detail({along.x, along.y}, {along.z, along.w});
            largest = std::max(
                largest,
                largest_difference(
                    found[i], sample_texture(texels, one.rules, {point.x, point.y, 0.5}, level)));
        }
        // Fractions of levels have few bits; software approximates their logarithm.
        report.at_most(fmt::format("2D, {}: largest difference", one.name), largest, 0.03);
    }
    return Done{};
}

// A floor of checks that reaches far away.
constexpr int kWidth = 96;  ///< [px]
constexpr int kHeight = 64;
constexpr int kSamples = 24;      ///< of the oracle in a row of a pixel
constexpr double kExtent = 60;    ///< from the center to an edge [m]
constexpr int kFloorTexels = 64;  ///< in a meter

double check_at(int x, int y) {
    return ((x / 16 + y / 16) % 2 == 0) ? 0.9 : 0.1;
}

oracle::TexelPyramid floor_texels() {
    oracle::TexelLevel level = {.width = kFloorTexels, .height = kFloorTexels, .texels = {}};
    for (int y = 0; y < kFloorTexels; ++y) {
        for (int x = 0; x < kFloorTexels; ++x) {
            level.texels.emplace_back(dvec3(check_at(x, y)), 1);
        }
    }
    return {{level}};
}

ImageData floor_image(const oracle::TexelPyramid& texels) {
    ImageData image = {
        .name = "checks",
        .width = kFloorTexels,
        .height = kFloorTexels,
        .format = PixelFormat::Rgba32F,
        .pixels = {}};
    for (const dvec4& texel : texels.levels[0].texels) {
        const Vec4 value(texel);
        std::array<std::uint8_t, sizeof(Vec4)> bytes;
        std::memcpy(bytes.data(), &value, sizeof(Vec4));
        image.pixels.insert(image.pixels.end(), bytes.begin(), bytes.end());
    }
    return image;
}

/// The mean of the floor over each pixel.
gpu::FloatImage floor_oracle(const oracle::TexelPyramid& texels, const RenderView& view) {
    gpu::FloatImage image{.width = kWidth, .height = kHeight, .channels = 3, .pixels = {}};
    const dvec3 eye = eye_of(view);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            double sum = 0;
            for (int k = 0; k < kSamples * kSamples; ++k) {
                const dvec3 ray = pixel_ray(
                    view, x + (k % kSamples + 0.5) / kSamples - 0.5,
                    y + (k / kSamples + 0.5) / kSamples - 0.5);
                const dvec3 at = eye - ray * (eye.y / ray.y);
                if (ray.y < 0 && std::max(std::abs(at.x), std::abs(at.z)) < kExtent) {
                    sum += sample_texture(texels, {}, {at.x + kExtent, at.z + kExtent, 0.5}, -1).x;
                }
            }
            image.pixels.insert(
                image.pixels.end(), 3, static_cast<float>(sum / (kSamples * kSamples)));
        }
    }
    return image;
}

double rms_difference(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double difference =
                static_cast<double>(a.at(x, y, 0)) - static_cast<double>(b.at(x, y, 0));
            sum += difference * difference;
        }
    }
    return std::sqrt(sum / (kWidth * kHeight));
}

struct FloorFilter {
    const char* name;
    Minify minify;
    float anisotropy;
};

void measure_floor(HeadlessRenderer& headless, QualityReport& report) {
    const RenderView view = quality_view({0, 1.2f, 0}, {0, 0.35f, -3}, kWidth, kHeight, 0.8f);
    const oracle::TexelPyramid texels = floor_texels();
    const gpu::FloatImage exact = floor_oracle(texels, view);
    double previous = 1;
    for (const FloorFilter& filter : {
             FloorFilter{"nearest", Minify::Nearest, 1},
             FloorFilter{"linear_mipmap_linear", Minify::LinearMipLinear, 1},
             FloorFilter{"anisotropy 16", Minify::LinearMipLinear, 16},
         }) {
        QualityScene scene;
        Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        material.base_color_texture = {
            .image = scene.add(floor_image(texels)),
            .minify = filter.minify,
            .scale = Vec2(2 * kExtent),
            .anisotropy = filter.anisotropy};
        scene.place(
            scene.add(quality_square()), scene.add(material),
            affine_from(
                {0, 0, 0}, glm::angleAxis(-std::numbers::pi_v<float> / 2, Vec3(1, 0, 0)),
                Vec3(static_cast<float>(kExtent))));
        const gpu::FloatImage found = scene.render(headless, view);
        const double error = rms_difference(found, exact);
        report.at_most(
            fmt::format("floor, {}: RMS difference from the mean over each pixel", filter.name),
            error, previous);
        previous = 0.9 * error;  // of the next
        report.images.push_back(
            {fmt::format("floor, {}", filter.name), displayed(found), displayed(exact)});
    }
}

Status measure_sampling(HeadlessRenderer& headless, QualityReport& report) {
    LIMN_TRY(measure_forms(*headless.device, report));
    LIMN_TRY(measure_filters(*headless.device, report));
    measure_floor(headless, report);
    return Done{};
}

const RegisterQuality kRegistered(
    "sampling", "texture lookups in double precision, and the mean of a floor over each pixel",
    measure_sampling);

}  // namespace
}  // namespace limn::sampling_quality
