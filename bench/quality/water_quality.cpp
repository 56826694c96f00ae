#include "bench/oracles/water_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/base/optics.h"
#include "ecs/components/environment.h"
#include "ecs/components/water.h"
#include "ecs/components/water_look.h"
#include "render/render_frame.h"
#include "render/water/ocean_fft.h"
#include "systems/water/ocean_cascades.h"
#include "systems/water/ocean_spectrum.h"
#include "systems/water/ocean_system.h"
#include "systems/water/water_dispersion.h"
#include "systems/water/water_ripple_field.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace limn::water_quality {
namespace {

constexpr float kStep = 1.0f / 60.0f;
constexpr double kTime = 600.25;  ///< [s]
constexpr double kLargestError = 1e-4;
constexpr std::size_t kFields = 8;

using Plane = std::vector<double>;
using Planes = std::array<Plane, kFields>;

OceanState ocean_at(const Ocean& ocean, double time) {
    OceanState state;
    step_ocean(ocean, time, kStep, state);
    return state;
}

Planes planes_of(const OceanCascade& cascade) {
    const auto plane = [](const std::vector<float>& field) {
        return Plane(field.begin(), field.end());
    };
    return {plane(cascade.height),   plane(cascade.shift_x), plane(cascade.shift_z),
            plane(cascade.slope_x),  plane(cascade.slope_z), plane(cascade.shift_xx),
            plane(cascade.shift_zz), plane(cascade.shift_xz)};
}

Planes planes_of(const oracle::OceanPlanes& sum) {
    return {sum.height,  sum.shift_x,  sum.shift_z,  sum.slope_x,
            sum.slope_z, sum.shift_xx, sum.shift_zz, sum.shift_xz};
}

Planes planes_of(const OceanFields& fields, int cascade) {
    const gpu::FloatImage moved = gpu::read_floats(fields.displacement, 0, cascade);
    const gpu::FloatImage bent = gpu::read_floats(fields.derivatives, 0, cascade);
    const auto plane = [](const gpu::FloatImage& image, int channel) {
        Plane field;
        for (int z = 0; z < image.height; ++z) {
            for (int x = 0; x < image.width; ++x) {
                field.push_back(image.at(x, image.height - 1 - z, channel));
            }
        }
        return field;
    };
    return {plane(moved, 1), plane(moved, 0), plane(moved, 2), plane(bent, 0),
            plane(bent, 1),  plane(bent, 2),  plane(bent, 3),  plane(moved, 3)};
}

/// Largest difference over all fields, each relative to the field's largest value.
double relative_error(const Planes& found, const Planes& exact) {
    double worst = 0;
    for (std::size_t field = 0; field < kFields; ++field) {
        double error = 0;
        double largest = 0;
        for (std::size_t i = 0; i < exact[field].size(); ++i) {
            error = std::max(error, std::abs(found[field][i] - exact[field][i]));
            largest = std::max(largest, std::abs(exact[field][i]));
        }
        worst = std::max(worst, error / largest);
    }
    return worst;
}

/// The fields of a cascade, with its grid size and patch length [m].
struct Layer {
    Planes planes;
    int size = 0;
    double patch = 0;
};

/// Bilinear.
double sample(const Layer& layer, std::size_t field, double x, double z) {
    const auto at = [&](int i, int j) {
        return layer.planes[field][j % layer.size * layer.size + i % layer.size];
    };
    const double u = x / layer.patch * layer.size;
    const double v = z / layer.patch * layer.size;
    const int i = static_cast<int>(u);
    const int j = static_cast<int>(v);
    const double s = u - i;
    const double t = v - j;
    return (1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j))
           + t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1));
}

/// Forty meters of all cascades from above, reflecting the sky and a low sun.
ColorImage render_from_above(const std::vector<Layer>& layers) {
    constexpr int kPixels = 256;
    constexpr double kMeters = 40;
    const Vec3 halfway = glm::normalize(glm::normalize(Vec3(-0.7f, 0.45f, 0.4f)) + Vec3(0, 1, 0));
    gpu::FloatImage image = {kPixels, kPixels, 3, {}};
    for (int y = 0; y < kPixels; ++y) {
        for (int x = 0; x < kPixels; ++x) {
            double slope_x = 0;
            double slope_z = 0;
            for (const Layer& layer : layers) {
                slope_x += sample(layer, 3, x * kMeters / kPixels, y * kMeters / kPixels);
                slope_z += sample(layer, 4, x * kMeters / kPixels, y * kMeters / kPixels);
            }
            const Vec3 normal = glm::normalize(
                Vec3(-static_cast<float>(slope_x), 1.0f, -static_cast<float>(slope_z)));
            // By eye: toward the sun the sky is brighter, and some facets reflect the sun itself.
            const float toward = 0.5f - 1.6f * normal.x + 0.9f * normal.z;
            const float glint = std::pow(std::max(glm::dot(normal, halfway), 0.0f), 180.0f);
            const Vec3 color = glm::mix(
                                   Vec3(0.004f, 0.03f, 0.05f), Vec3(0.12f, 0.28f, 0.36f),
                                   std::clamp(toward, 0.0f, 1.0f))
                               + glint * Vec3(1.4f, 1.1f, 0.7f);
            image.pixels.insert(image.pixels.end(), {color.x, color.y, color.z});
        }
    }
    return displayed(image);
}

Result<OceanFft> synthesize_on_gpu(gpu::Device& device, const OceanState& state) {
    OceanFft fft = LIMN_TRY(create_ocean_fft(device, state));
    FrameGraph graph(device);
    graph.begin_frame();
    graph.keep(synthesize_ocean(graph, fft, state.made_for.choppiness, state.time).displacement);
    graph.execute();
    return fft;
}

/// Compares the fields of the CPU kernels and of the GPU with explicit sums of all waves.
Status measure_fields(gpu::Device& device, QualityReport& report) {
    const Ocean ocean = {.wind_speed = 8, .wind_direction = 0.6f, .patch = 90, .resolution = 64};
    const OceanState state = ocean_at(ocean, kTime);
    const OceanFft fft = LIMN_TRY(synthesize_on_gpu(device, state));
    std::vector<Layer> found;
    std::vector<Layer> exact;
    for (std::size_t c = 0; c < state.cascades.size(); ++c) {
        const OceanCascade& cascade = state.cascades[c];
        const auto layer = [&](Planes planes) {
            return Layer{std::move(planes), cascade.size, static_cast<double>(cascade.patch)};
        };
        found.push_back(layer(planes_of(cascade)));
        exact.push_back(layer(planes_of(oracle::ocean_planes(cascade, 1.0, kTime))));
        const Planes on_gpu = planes_of(fft.fields, static_cast<int>(c));
        const auto row = [&](const char* who, double error) {
            report.at_most(
                fmt::format("patch of {:.0f} m, {}: largest error", cascade.patch, who), error,
                kLargestError);
        };
        row("kernels", relative_error(found.back().planes, exact.back().planes));
        row("GPU", relative_error(on_gpu, exact.back().planes));
    }
    report.images.push_back(
        {"forty meters of sea from above", render_from_above(found), render_from_above(exact)});
    return Done{};
}

/// Significant wave height (four standard deviations) over 32 seeds, compared with the spectrum's.
void measure_height(OceanSpectrum spectrum, const char* name, QualityReport& report) {
    Ocean ocean = {.spectrum = spectrum, .wind_speed = 6, .patch = 150, .resolution = 32};
    const OceanEnergy sea = make_ocean_energy(ocean);
    double m0 = 0;
    constexpr double kBit = 1e-3;
    for (double omega = kBit; omega < 60; omega += kBit) {
        m0 += frequency_energy(sea, omega) * kBit;
    }
    double sum = 0;
    for (ocean.seed = 1; ocean.seed <= 32; ++ocean.seed) {
        for (const OceanCascade& cascade : ocean_at(ocean, 0.0).cascades) {
            double squares = 0;
            for (const float h : cascade.height) {
                squares += square(static_cast<double>(h));
            }
            sum += squares / static_cast<double>(cascade.height.size());
        }
    }
    report.at_most(
        fmt::format("{}: error of the significant height", name),
        100 * std::abs(std::sqrt(sum / 32 / m0) - 1), 5, "%");
}

/// Phase speed of the wave (2, 1) of a patch over ten seconds, compared with the dispersion
/// relation.
void measure_speed(float depth, const char* name, QualityReport& report) {
    constexpr int kSize = 32;
    constexpr float kPatch = 40;
    OceanCascade cascade =
        make_ocean_cascades(
            {.wind_speed = 5, .depth = depth, .cascades = 1, .patch = kPatch, .resolution = kSize})
            .front();
    const std::size_t wave = 2 * kSize + 1;
    const std::size_t mirrored = (kSize - 2) * kSize + kSize - 1;
    for (std::size_t i = 0; i < cascade.ahead_re.size(); ++i) {
        if (i != wave) {
            cascade.ahead_re[i] = cascade.ahead_im[i] = 0;
        }
        if (i != mirrored) {
            cascade.behind_re[i] = cascade.behind_im[i] = 0;
        }
    }
    const auto phase_at = [&](double time) {
        synthesize_waves(cascade, 1.0f, time);
        oracle::Complex sum = 0;
        for (int i = 0; i < kSize * kSize; ++i) {
            const double angle = -oracle::kFullTurn * (2 * (i % kSize) + i / kSize) / kSize;
            sum += static_cast<double>(cascade.height[i]) * std::polar(1.0, angle);
        }
        return std::arg(sum);
    };
    // Phase steps shorter than a period, summed.
    const double k = oracle::kFullTurn / static_cast<double>(kPatch) * std::sqrt(5.0);
    constexpr double kWait = 0.5;
    double turned = 0;
    for (int i = 0; i < 20; ++i) {
        const double before = phase_at(i * kWait);
        turned += std::remainder(before - phase_at((i + 1) * kWait), oracle::kFullTurn);
    }
    report.at_most(
        fmt::format("{}: error of the phase speed", name),
        100 * std::abs(turned / (20 * kWait) / k / phase_speed(k, depth) - 1), 0.1, "%");
}

/// Volume error of a step, relative to the volume displaced from rest.
void measure_volume(QualityReport& report) {
    const Water water = {.size = {12, 9}, .depth = 2};
    const WaterRipples ripples = {};
    RippleState state = make_ripples(water, ripples, kStep);
    double worst = 0;
    for (int i = 0; i < 600; ++i) {
        if (i % 40 == 0) {
            const float x = -5.0f + static_cast<float>(i) / 60.0f;
            state.impulses.push_back({.center = {x, 0.3f * x}, .radius = 0.5f, .height = -0.2f});
        }
        const double before = ripple_volume(state);
        step_ripples(state, ripples, kStep);
        double moved = 0;
        for (int z = 0; z < state.cells.y; ++z) {
            for (int x = 0; x < state.cells.x; ++x) {
                moved += std::abs(static_cast<double>(state.height[state.at(x, z)]));
            }
        }
        moved *= square(static_cast<double>(state.cell));
        worst = std::max(worst, std::abs(ripple_volume(state) - before) / moved);
    }
    report.at_most("ripples: volume error of a step", worst, 1e-6);
}

// ---- reflections of still water

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr float kIndex = 1.333f;
const Vec3 kEye = {0.5f, 1.7f, 4};
const Vec3 kTarget = {0, 0.7f, -2};

/// Colored boards in and above still, dark water at y = 0.
void build_shore(QualityScene& scene) {
    scene.world.insert_resource(Environment{
        .sky = SkyKind::Uniform,
        .zenith = Vec3(0.45f),
        .horizon = Vec3(0.45f),
        .ground = Vec3(0.45f),
        .visible = true});
    MeshData board = quality_square();
    board.colors = {
        {0.9f, 0.2f, 0.1f, 1}, {0.1f, 0.8f, 0.2f, 1}, {0.2f, 0.3f, 0.9f, 1}, {0.9f, 0.9f, 0.2f, 1}};
    const MeshId mesh = scene.add(std::move(board));
    const MaterialId plain =
        scene.add(Material{.shading = ShadingModel::Unlit, .double_sided = true});
    const auto stand = [&](const Vec3& at, float turn, const Vec3& size) {
        scene.place(mesh, plain, affine_from(at, glm::angleAxis(turn, Vec3(0, 1, 0)), size));
    };
    stand({0, 1.2f, -6}, 0, {5, 1.4f, 1});
    stand({-2.2f, 0.3f, -3}, 0.5f, {0.5f, 0.8f, 1});
    stand({1.6f, 0.6f, -2.5f}, -0.4f, {0.4f, 0.4f, 1});
    stand({0.2f, 1.5f, -4}, 0.1f, {0.3f, 0.3f, 1});
}

gpu::FloatImage
depth_of(HeadlessRenderer& headless, const QualityScene& scene, const RenderView& view) {
    const FrameOutput out =
        render_frame(*headless.renderer, scene.world, view, {.aovs = {"depth"}});
    return gpu::read_floats(*out.aovs[0].texture);
}

/// Ray through a pixel's center, one meter long along the view axis; row 0 is the top.
Vec3 ray_through(const RenderView& view, int x, int y) {
    const Vec2 ndc = (Vec2(x, kHeight - 1 - y) + 0.5f) / Vec2(kWidth, kHeight) * 2.0f - 1.0f;
    const auto& pose = view.world_from_camera.row;
    const Vec3 in_camera(ndc * view.tangent, -1);
    return {
        glm::dot(Vec3(pose[0]), in_camera), glm::dot(Vec3(pose[1]), in_camera),
        glm::dot(Vec3(pose[2]), in_camera)};
}

/// The oracle's reflection at each pixel, whether the pixel is water, and whether the reflected
/// point is on screen.
struct MirroredTruth {
    gpu::FloatImage radiance;
    std::vector<bool> is_water;
    std::vector<bool> is_on_screen;
};

Vec3 mirrored(const Vec3& p) {
    return {p.x, -p.y, p.z};
}

MirroredTruth trace_truth(HeadlessRenderer& headless, QualityScene& shore, const RenderView& view) {
    // The mirrored camera's image is upside down.
    const RenderView below = quality_view(mirrored(kEye), mirrored(kTarget), kWidth, kHeight, 1);
    const gpu::FloatImage from_below = shore.radiance(headless, below);
    const gpu::FloatImage mirrored_depth = depth_of(headless, shore, below);
    const gpu::FloatImage shown_depth = depth_of(headless, shore, view);
    MirroredTruth truth = {from_below, {}, {}};
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const int row = kHeight - 1 - y;
            const auto channels = static_cast<std::size_t>(from_below.channels);
            const std::size_t to = (static_cast<std::size_t>(y) * kWidth + x) * channels;
            const std::size_t from = (static_cast<std::size_t>(row) * kWidth + x) * channels;
            std::copy_n(
                from_below.pixels.begin() + from, channels, truth.radiance.pixels.begin() + to);
            const Vec3 ray = ray_through(view, x, y);
            const float surface = ray.y < -1e-3f ? kEye.y / -ray.y : kNoDepth;
            truth.is_water.push_back(surface < shown_depth.at(x, y, 0) && surface < 60);
            // The pixel of the reflected point in the camera's own image.
            const float away = mirrored_depth.at(x, row, 0);
            const Vec3 point = mirrored(kEye) + ray_through(below, x, row) * away;
            const Vec4 clip = view.clip_from_world * Vec4(point, 1);
            const Vec2 pixel =
                (0.5f + 0.5f * Vec2(clip.x, clip.y) / clip.w) * Vec2(kWidth, kHeight);
            const auto column = static_cast<int>(std::floor(pixel.x));
            const int line = kHeight - 1 - static_cast<int>(std::floor(pixel.y));
            const bool inside = away < kNoDepth && point.y > 0.03f && column >= 0 && column < kWidth
                                && line >= 0 && line < kHeight;
            truth.is_on_screen.push_back(
                inside && std::abs(shown_depth.at(column, line, 0) - clip.w) < 0.02f * clip.w);
        }
    }
    return truth;
}

/// PSNR over the pixels of `counts` that are water [dB], of radiance divided by the Fresnel
/// reflectance.
double psnr_of(
    const gpu::FloatImage& image, const MirroredTruth& truth, const std::vector<bool>& counts,
    const RenderView& view) {
    double squares = 0;
    double samples = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * kWidth + x;
            if (!truth.is_water[i] || !counts[i]) {
                continue;
            }
            const float reflectance = fresnel(-glm::normalize(ray_through(view, x, y)).y, kIndex);
            for (int c = 0; c < 3; ++c) {
                squares += square(static_cast<double>(
                    image.at(x, y, c) / reflectance - truth.radiance.at(x, y, c)));
                samples += 1;
            }
        }
    }
    LIMN_CHECK(samples > kWidth * kHeight / 10);  // enough pixels to compare
    return -10 * std::log10(std::max(squares / samples, 1e-12));
}

void measure_reflections(HeadlessRenderer& headless, QualityReport& report) {
    QualityScene shore;
    build_shore(shore);
    const RenderView view = quality_view(kEye, kTarget, kWidth, kHeight, 1);
    const MirroredTruth truth = trace_truth(headless, shore, view);
    const Entity water = shore.world.create(
        Water{.refractive_index = kIndex, .absorption = Vec3(1000), .scattering = Vec3(0)},
        WorldTransform{placed_at({0, 0, 0})});
    const std::vector<bool> all(truth.is_water.size(), true);
    const auto measure = [&](const char* name, const WaterLook& look,
                             const std::vector<bool>& counts, double min_psnr) {
        shore.world.add(water, look);
        const gpu::FloatImage image = shore.radiance(headless, view);
        shore.world.remove<WaterLook>(water);
        report.at_least(name, psnr_of(image, truth, counts, view), min_psnr, "dB");
        return image;
    };
    const WaterLook planar = {.reflection = WaterReflection::Planar, .map_scale = 1};
    const gpu::FloatImage image =
        measure("still water, planar reflection against a mirrored camera", planar, all, 45);
    measure("the same at half resolution", {.reflection = WaterReflection::Planar}, all, 30);
    measure(
        "screen-space reflection, where the reflected point is on screen", {}, truth.is_on_screen,
        20);
    report.images.push_back(
        {"still water: planar reflection, mirrored camera", displayed(image),
         displayed(truth.radiance)});
}

Status measure_water(HeadlessRenderer& headless, QualityReport& report) {
    LIMN_TRY(measure_fields(*headless.device, report));
    measure_height(OceanSpectrum::WindSea, "wind sea", report);
    measure_height(OceanSpectrum::Jonswap, "JONSWAP", report);
    measure_speed(500.0f, "deep water", report);
    measure_speed(1.0f, "shallow water", report);
    measure_volume(report);
    measure_reflections(headless, report);
    return Done{};
}

const RegisterQuality kRegistered(
    "water", "Fourier sums term by term in double precision, the dispersion relation",
    measure_water);

}  // namespace
}  // namespace limn::water_quality
