#include "bench/oracles/tone_oracle.h"
#include "bench/quality/quality_scene.h"
#include "content/make/models/shapes.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/shadow.h"
#include "render/shaders/tone_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn::tone_quality {
namespace {

using glm::dvec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kSamples = 4;

// ---- the scene

/// The view through the gate: sky over trees, brightest at the horizon.
ImageData make_garden() {
    constexpr int kSide = 64;
    ImageData image{.name = "garden", .width = kSide, .height = kSide, .srgb = true, .pixels = {}};
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const double leaves =
                0.5 + 0.5 * std::sin(0.9 * x + std::sin(0.7 * y)) * std::cos(1.1 * y);
            const double trees = 40 + 6 * std::sin(0.35 * x) + 3 * std::sin(0.9 * x + 1);
            const double height = static_cast<double>(y) / kSide;
            const dvec3 color = y < trees ? dvec3(0.45 + 0.5 * height, 0.65 + 0.3 * height, 0.95)
                                          : (0.15 + 0.35 * leaves) * dvec3(0.7, 1, 0.3);
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<std::uint8_t>(255 * std::min(color[c], 1.0)));
            }
            image.pixels.push_back(255);
        }
    }
    return image;
}

/// Five decades of luminance: a courtyard by lamplight, and a bright garden through its gate.
void populate_evening(QualityScene& scene) {
    populate_court(scene);
    scene.world.insert_resource(
        Environment{.sky = SkyKind::Uniform, .zenith = {0.005f, 0.006f, 0.01f}, .visible = false});
    scene.place(
        scene.add(quality_square()),
        scene.add(Material{
            .base_color = {0, 0, 0, 1},
            .emission = {60, 60, 60},
            .emission_texture = {.image = scene.add(make_garden())}}),
        affine_from({-0.8f, 1.1f, -3.4f}, {1, 0, 0, 0}, {1.6f, 1.4f, 1}));
    constexpr Vec3 kLamp = {0.5f, 1.6f, 1.1f};
    scene.world.add(
        scene.place(
            scene.add(make_sphere({.radius = 0.07f, .segments = 24, .rings = 12})),
            scene.add(Material{.base_color = {0, 0, 0, 1}, .emission = {500, 330, 160}}),
            placed_at(kLamp)),
        NoShadow{});
    scene.world.add(
        scene.add_light(
            PointLight{.color = {1, 0.66f, 0.32f}, .intensity = 9, .radius = 12}, placed_at(kLamp)),
        Shadow{.filter = ShadowFilter::Soft});
}

/// Rows from the top.
std::vector<dvec3> pixels_of(const gpu::FloatImage& image) {
    std::vector<dvec3> pixels;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            pixels.emplace_back(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
        }
    }
    return pixels;
}

// ---- the oracle

/// Tone maps an image by `exposure` with the oracle's formulas.
std::vector<dvec3> tone_map_exactly(
    const std::vector<dvec3>& pixels, const oracle::ImageStatistics& statistics,
    const Exposure& exposure) {
    const bool metered = exposure.metering != Metering::Manual;
    const double scale = std::exp2(static_cast<double>(exposure.ev))
                         * (metered ? exposure.key / statistics.log_average : 1.0);
    const dvec3 haze = static_cast<double>(exposure.defog) * statistics.mean;
    std::vector<double> luminances;
    for (const dvec3& pixel : pixels) {
        luminances.push_back(oracle::luminance(scale * glm::max(pixel - haze, 0.0)));
    }
    oracle::DodgeBurn local;
    if (exposure.curve == ToneCurve::Local) {
        local = oracle::dodge_burn(luminances, kWidth, kHeight);
    }
    std::vector<dvec3> shown;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        dvec3 color = scale * glm::max(pixels[i] - haze, 0.0);
        const auto with_luminance = [&](double display) {
            return luminances[i] > 0 ? color * (display / luminances[i]) : dvec3(0);
        };
        switch (exposure.curve) {
        case ToneCurve::Neutral:
            color = oracle::pbr_neutral(color);
            break;
        case ToneCurve::Aces:
            color = oracle::aces_fit(1.4619 * color);  // 18 % gray stays 18 %
            break;
        case ToneCurve::Linear:
            break;
        case ToneCurve::Reinhard:
            color = with_luminance(oracle::compress(luminances[i], exposure.white));
            break;
        case ToneCurve::Local:
            color = with_luminance(local.display[i]);
            break;
        case ToneCurve::Knee:
            for (int c = 0; c < 3; ++c) {
                color[c] = oracle::knee_map(
                    pixels[i][c], haze[c],
                    {.exposure = scale,
                     .contrast = exposure.contrast,
                     .exponent = 1.0 / exposure.gamma});
            }
            shown.push_back(glm::min(color, 1.0));
            continue;
        }
        const bool srgb = exposure.encoding == DisplayEncoding::Srgb;
        for (int c = 0; c < 3; ++c) {
            color[c] = srgb ? oracle::srgb_encode(color[c])
                            : oracle::gamma_encode(std::min(color[c], 1.0), exposure.gamma);
        }
        shown.push_back(color);
    }
    return shown;
}

// ---- measurements

void measure_statistics(
    const layout::ImageStatistics& found, const oracle::ImageStatistics& exact, float key,
    QualityReport& report) {
    const auto row = [&report](const char* name, double off, double most) {
        report.at_most(name, off, most, "%");
    };
    constexpr double kSame = 0.1;  // hdr.log-average: GPU and CPU agree to 1e-3
    row("error of the log-average luminance", percent_error(found.luminance.x, exact.log_average),
        kSame);
    double mean = 0;
    for (int c = 0; c < 3; ++c) {
        mean = std::max(mean, percent_error(found.mean_scale[c], exact.mean[c]));
    }
    row("error of the mean color", mean, kSame);
    row("error of the dynamic range",
        percent_error(
            static_cast<double>(found.luminance.w) / found.luminance.z,
            exact.largest / exact.least),
        kSame);
    row("error of the dynamic range without the outermost 0.1 %",
        percent_error(
            static_cast<double>(found.clipped.y) / found.clipped.x,
            exact.clipped_max_luminance / exact.clipped_min_luminance),
        // One histogram bin at either end.
        100 * (std::exp2(2.2 / layout::kBinsPerStop) - 1));
    row("metered: difference of the log-average luminance from the key",
        percent_error(found.mean_scale.w * exact.log_average, key), kSame);
    report.inform("dynamic range of the image", exact.largest / exact.least, ": 1");
}

/// Differences of display codes.
struct CodeError {
    double mean = 0;
    double largest = 0;
    double far_off = 0;  ///< percentage of channels off by more than 2.5 codes
};

CodeError compare(const gpu::ByteImage& found, const std::vector<dvec3>& expected) {
    CodeError error;
    const double values = 3.0 * static_cast<double>(expected.size());
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double exact = 255 * expected[static_cast<std::size_t>(y * kWidth + x)][c];
                const double off = std::abs(found.at(x, y, c) - exact);
                error.mean += off / values;
                error.largest = std::max(error.largest, off);
                error.far_off += off > 2.5 ? 100 / values : 0;
            }
        }
    }
    return error;
}

ColorImage image_of(const std::vector<dvec3>& pixels) {
    return {kWidth, kHeight, {pixels.begin(), pixels.end()}};
}

struct Operator {
    const char* name;
    Exposure exposure;
};

std::vector<Operator> operators() {
    constexpr Metering kKey = Metering::Key;
    return {
        {"clamp and gamma 2.2",
         {.curve = ToneCurve::Linear,
          .metering = kKey,
          .encoding = DisplayEncoding::Power,
          .dither = false}},
        {"global curve",
         {.curve = ToneCurve::Reinhard, .metering = kKey, .white = 60, .dither = false}},
        {"dodge and burn", {.curve = ToneCurve::Local, .metering = kKey, .dither = false}},
        {"ACES fit", {.curve = ToneCurve::Aces, .metering = kKey, .dither = false}},
        {"Khronos neutral", {.curve = ToneCurve::Neutral, .metering = kKey, .dither = false}},
        {"knee", {.ev = 3, .curve = ToneCurve::Knee, .contrast = 0.1f, .dither = false}},
        {"knee with more exposure, contrast and defog",
         {.ev = 5, .curve = ToneCurve::Knee, .contrast = 1, .defog = 0.01f, .dither = false}},
    };
}

Status measure_tone(HeadlessRenderer& headless, QualityReport& report) {
    ImageBench bench(*headless.device, LIMN_TRY(create_tone_mapper(*headless.device)));
    QualityScene scene;
    populate_evening(scene);
    const gpu::Texture& radiance =
        *render_accumulated(*headless.renderer, scene.world, court_view(kWidth, kHeight), kSamples)
             .radiance;
    const std::vector<dvec3> pixels = pixels_of(gpu::read_floats(radiance));
    const oracle::ImageStatistics exact = oracle::measure_image(pixels);
    constexpr float kKey = 0.18f;

    StatisticsPass& statistics = bench.tone_mapper.statistics;
    bench.graph.begin_frame();
    static_cast<void>(measure_image(
        bench.graph, statistics, bench.graph.import("radiance", radiance),
        {.key = kKey, .histogram = true}));
    bench.graph.execute();
    measure_statistics(
        statistics.measure.read_value<layout::ImageStatistics>(0), exact, kKey, report);

    for (const Operator& tone : operators()) {
        const gpu::ByteImage found = bench.display(radiance, tone.exposure);
        const std::vector<dvec3> expected = tone_map_exactly(pixels, exact, tone.exposure);
        const CodeError error = compare(found, expected);
        if (tone.exposure.curve == ToneCurve::Local) {
            // Each pixel selects one of nine blur scales. If two fit equally well, the GPU may pick
            // the other one; and its larger blurs are computed at half and quarter resolution.
            report.at_most(fmt::format("{}, mean difference", tone.name), error.mean, 0.7, "codes");
            report.at_most(
                fmt::format("{}, more than 2.5 codes off", tone.name), error.far_off, 2, "%");
        } else {
            report.at_most(
                fmt::format("{}, largest difference", tone.name), error.largest,
                0.6,  // of which half a code is rounding to 8 bits
                "codes");
        }
        report.images.push_back({tone.name, color_image(found), image_of(expected)});
    }
    return Done{};
}

const RegisterQuality kRegistered(
    "tone", "statistics and tone operators in double precision, with exact Gaussians",
    measure_tone);

}  // namespace
}  // namespace limn::tone_quality
