#include "content/app/quality_water.h"

#include "bench/oracles/water_oracle.h"
#include "content/app/quality_scene.h"
#include "content/app/quality_water_reflection.h"
#include "render/gpu/readback.h"
#include "render/graph/frame_graph.h"
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

namespace limn {
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

/// Of all fields the largest difference, over the largest value of the field.
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

/// A cascade's fields with its place among the others.
struct Layer {
    Planes planes;
    int size = 0;
    double patch = 0;
};

/// Between the four nearest points.
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

/// Forty meters of all cascades from above, the sky mirrored and the sun low.
ColorImage seen_from_above(const std::vector<Layer>& layers) {
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
            // By eye: toward the sun the sky is brighter, and some facets mirror the sun itself.
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
    Result<OceanFft> fft = create_ocean_fft(device, state);
    if (fft) {
        FrameGraph graph(device);
        graph.begin_frame();
        graph.keep(
            synthesize_ocean(graph, *fft, state.made_for.choppiness, state.time).displacement);
        graph.execute();
    }
    return fft;
}

/// The fields of the kernels and of the GPU, beside sums of all waves.
Status measure_fields(gpu::Device& device, QualityReport& report) {
    const Ocean ocean = {.wind_speed = 8, .wind_direction = 0.6f, .patch = 90, .resolution = 64};
    const OceanState state = ocean_at(ocean, kTime);
    const Result<OceanFft> fft = synthesize_on_gpu(device, state);
    if (!fft) {
        return fft.error();
    }
    std::vector<Layer> found;
    std::vector<Layer> exact;
    for (std::size_t c = 0; c < state.cascades.size(); ++c) {
        const OceanCascade& cascade = state.cascades[c];
        const auto layer = [&](Planes planes) {
            return Layer{std::move(planes), cascade.size, static_cast<double>(cascade.patch)};
        };
        found.push_back(layer(planes_of(cascade)));
        exact.push_back(layer(planes_of(oracle::ocean_planes(cascade, 1.0, kTime))));
        const Planes on_gpu = planes_of(fft->fields, static_cast<int>(c));
        const auto row = [&](const char* who, double error) {
            report.rows.push_back(
                {fmt::format("patch of {:.0f} m, {}: largest error", cascade.patch, who), error,
                 QualityBound::AtMost, kLargestError, ""});
        };
        row("kernels", relative_error(found.back().planes, exact.back().planes));
        row("GPU", relative_error(on_gpu, exact.back().planes));
    }
    report.pictures.push_back(
        {"forty meters of sea from above", seen_from_above(found), seen_from_above(exact)});
    return Done{};
}

/// Four standard deviations of the height, over 32 seas, beside what the spectrum says.
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
    report.rows.push_back(
        {fmt::format("{}: significant height, off by", name),
         100 * std::abs(std::sqrt(sum / 32 / m0) - 1), QualityBound::AtMost, 5, "%"});
}

/// How far the wave (2, 1) of a patch has run after some seconds, beside what the dispersion says.
void measure_speed(float depth, const char* name, QualityReport& report) {
    constexpr int kSize = 32;
    constexpr float kPatch = 40;
    OceanCascade cascade =
        make_ocean_cascades(
            {.wind_speed = 5, .depth = depth, .cascades = 1, .patch = kPatch, .resolution = kSize})
            .front();
    const std::size_t ours = 2 * kSize + 1;
    const std::size_t mirrored = (kSize - 2) * kSize + kSize - 1;
    for (std::size_t i = 0; i < cascade.ahead_re.size(); ++i) {
        if (i != ours) {
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
    // Short enough that it is not a whole wave, then added up.
    const double k = oracle::kFullTurn / static_cast<double>(kPatch) * std::sqrt(5.0);
    constexpr double kWait = 0.5;
    double turned = 0;
    for (int i = 0; i < 20; ++i) {
        const double before = phase_at(i * kWait);
        turned += std::remainder(before - phase_at((i + 1) * kWait), oracle::kFullTurn);
    }
    report.rows.push_back(
        {fmt::format("{}: speed of a wave, off by", name),
         100 * std::abs(turned / (20 * kWait) / k / phase_speed(k, depth) - 1),
         QualityBound::AtMost, 0.1, "%"});
}

/// Water that a step makes or loses, of all that is above or below rest.
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
    report.rows.push_back(
        {"ripples: water made or lost in a step", worst, QualityBound::AtMost, 1e-6, ""});
}

}  // namespace

Result<QualityReport> measure_water(HeadlessRenderer& headless) {
    QualityReport report;
    if (Status measured = measure_fields(*headless.device, report); !measured) {
        return measured.error();
    }
    measure_height(OceanSpectrum::WindSea, "wind sea", report);
    measure_height(OceanSpectrum::Jonswap, "JONSWAP", report);
    measure_speed(500.0f, "deep water", report);
    measure_speed(1.0f, "shallow water", report);
    measure_volume(report);
    measure_water_reflections(headless, report);
    return report;
}

}  // namespace limn
