#include "render/lens/local_luminance_pass.h"

#include "render/fullscreen.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/tone_gpu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

// Techniques: hdr.dodge-burn

namespace limn {
namespace {

constexpr int kFineRadius = 4;  // kernel radius of each level [texels]
constexpr int kMediumRadius = 11;
constexpr int kCoarseRadius = 14;
constexpr int kMediumStep = 2;  // pixels per texel
constexpr int kCoarseStep = 4;
constexpr double kBox2 = 0.25;         // variance of the mean of two neighbors [texels^2]
constexpr double kBilinear = 1.0 / 6;  // mean variance added by bilinear filtering [texels^2]

/// Variance of scale i [px^2]: (1.6^i a1)^2 / 2 with a1^2 = 1/8.
double scale_variance(int i) {
    return std::pow(1.6, 2 * i) / 16;
}

/// Weights 0 .. radius of a sampled Gaussian; the two-sided sum is 1.
std::array<double, 16> sample_gaussian(double sigma2, int radius) {
    std::array<double, 16> weights{};
    double sum = 0;
    for (int i = 0; i <= radius; ++i) {
        weights[i] = std::exp(-i * i / (2 * sigma2));
        sum += i == 0 ? weights[i] : 2 * weights[i];
    }
    for (double& weight : weights) {
        weight /= sum;
    }
    return weights;
}

double variance_of(const std::array<double, 16>& weights) {
    double sum = 0;
    for (int i = 1; i < 16; ++i) {
        sum += 2 * i * i * weights[i];
    }
    return sum;
}

/// The same with exactly this variance [texels^2], which sampling reduces for narrow Gaussians.
std::array<double, 16> gaussian_of_variance(double variance, int radius) {
    double low = 1e-3;
    double high = 2 * variance + 1;
    for (int i = 0; i < 50; ++i) {
        const double mid = 0.5 * (low + high);
        (variance_of(sample_gaussian(mid, radius)) < variance ? low : high) = mid;
    }
    return sample_gaussian(low, radius);
}

gpu::Buffer make_weights(const char* label, const std::array<std::array<double, 16>, 4>& blurs) {
    layout::BlurWeights block{};
    for (int i = 0; i < 16; ++i) {
        for (int k = 0; k < 4; ++k) {
            block.weight[i][k] = static_cast<float>(blurs[k][i]);
        }
    }
    return gpu::Buffer(label, sizeof(block), gpu::BufferUse::Static, &block);
}

/// Remaining blur on a grid of `step` pixels per texel, for a source of variance `done` [px^2].
std::array<double, 16> remaining(int scale, double done, int step, int radius) {
    const double left = (scale_variance(scale) - done) / (step * step) - kBilinear;
    return gaussian_of_variance(std::max(left, 0.01), radius);
}

enum class BlurSource : std::uint8_t { Radiance, OneComponent, Components };  // SOURCE

Result<const gpu::Program*> load_blur(gpu::Device& device, BlurSource source, int radius) {
    return load_fullscreen(
        device, "local_blur.frag",
        {{"SOURCE", std::to_string(static_cast<int>(source))}, {"RADIUS", std::to_string(radius)}});
}

using Weights = std::array<std::array<double, 16>, 4>;

Result<LocalLuminancePass::Level> create_level(
    gpu::Device& device, const char* label, BlurSource source, int radius, const Weights& weights) {
    return LocalLuminancePass::Level{
        LIMN_TRY(load_blur(device, source, radius)),
        LIMN_TRY(load_blur(device, BlurSource::Components, radius)), make_weights(label, weights)};
}

TextureId blur_along(
    FrameGraph& graph, std::string_view name, const gpu::Program* program,
    const gpu::Buffer& weights, TextureId source, const IVec2& direction) {
    const TextureId target = create_target(graph, name, GL_RGBA32F, size_of(graph, source));
    add_fullscreen_pass(
        graph, name, {sampled(source, layout::kSourceUnit)}, {discarded(target)}, program,
        [&weights, direction](PassContext& context, const gpu::Program& shader) {
            context.device().bind_uniforms(layout::kBlurWeightsBinding, weights);
            shader.set("direction", direction);
        });
    return target;
}

TextureId blur_level(
    FrameGraph& graph, std::string_view name_across, std::string_view name,
    const LocalLuminancePass::Level& level, TextureId source) {
    const TextureId across =
        blur_along(graph, name_across, level.across, level.weights, source, {1, 0});
    return blur_along(graph, name, level.up, level.weights, across, {0, 1});
}

TextureId downsample_luminance(
    FrameGraph& graph, std::string_view name, const gpu::Program* program, TextureId source,
    const IVec2& size) {
    const TextureId target = create_target(graph, name, GL_R32F, size);
    add_fullscreen_pass(
        graph, name, {sampled(source, layout::kSourceUnit)}, {discarded(target)}, program,
        [size](PassContext&, const gpu::Program& shader) {
            shader.set("texel", 1.0f / Vec2(size));
        });
    return target;
}

}  // namespace

Result<LocalLuminancePass> create_local_luminance_pass(gpu::Device& device) {
    Weights fine;
    Weights medium;
    Weights coarse{};
    for (int k = 0; k < 4; ++k) {
        fine[k] = sample_gaussian(scale_variance(k), kFineRadius);
        medium[k] = remaining(4 + k, scale_variance(3) + kBox2, kMediumStep, kMediumRadius);
    }
    for (int k = 0; k < 2; ++k) {
        const double done = scale_variance(7) + kBox2 * kMediumStep * kMediumStep;
        coarse[k] = remaining(8 + k, done, kCoarseStep, kCoarseRadius);
    }
    return LocalLuminancePass{
        LIMN_TRY(create_level(device, "fine blurs", BlurSource::Radiance, kFineRadius, fine)),
        LIMN_TRY(
            create_level(device, "medium blurs", BlurSource::OneComponent, kMediumRadius, medium)),
        LIMN_TRY(
            create_level(device, "coarse blurs", BlurSource::OneComponent, kCoarseRadius, coarse)),
        LIMN_TRY(load_fullscreen(device, "local_shrink.frag"))};
}

LocalLuminance
blur_luminance(FrameGraph& graph, const LocalLuminancePass& pass, TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    const auto reduced_size = [&spec](int step) {
        return IVec2((spec.width + step - 1) / step, (spec.height + step - 1) / step);
    };
    LocalLuminance blurs;
    blurs.fine = blur_level(graph, "local.fine across", "local.fine", pass.fine, radiance);
    const TextureId half = downsample_luminance(
        graph, "local.half", pass.downsample, blurs.fine, reduced_size(kMediumStep));
    blurs.medium = blur_level(graph, "local.medium across", "local.medium", pass.medium, half);
    const TextureId quarter = downsample_luminance(
        graph, "local.quarter", pass.downsample, blurs.medium, reduced_size(kCoarseStep));
    blurs.coarse = blur_level(graph, "local.coarse across", "local.coarse", pass.coarse, quarter);
    return blurs;
}

}  // namespace limn
