#include "bench/oracles/glare_oracle.h"
#include "bench/oracles/glow_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/components/glare.h"
#include "ecs/components/glow.h"
#include "render/lens/glare_pass.h"
#include "render/lens/glow_pass.h"
#include "render/render_frame.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace limn::glow_quality {
namespace {

using glm::dvec2;
using glm::dvec3;
using oracle::LightImage;

constexpr IVec2 kSize = {320, 180};
constexpr IVec2 kOddSize = {321, 179};

/// Runs glow, glare and tone mapping on synthetic images.
struct Bench : ImageBench {
    Bench(gpu::Device& device, ToneMapper made, GlowPass its_glow, GlarePass its_glare)
        : ImageBench(device, std::move(made)), glow_pass(its_glow),
          glare_pass(std::move(its_glare)) {}

    LightImage with_glow(const LightImage& image, const Glow& glow) {
        return run(image, [&](FrameGraph& frame, TextureId radiance) {
            return draw_glow(frame, glow_pass, glow, radiance);
        });
    }
    LightImage with_glare(const LightImage& image, const Glare& glare) {
        return run(image, [&](FrameGraph& frame, TextureId radiance) {
            return draw_glare(frame, glare_pass, glare, radiance);
        });
    }
    ColorImage tone_mapped(const LightImage& image, Exposure exposure) {
        exposure.dither = false;
        return display(image, exposure);
    }

    GlowPass glow_pass;
    GlarePass glare_pass;
};

/// A black image with one dot of a pixel's size at `position` [px from the top left], distributed
/// bilinearly over the pixels that it covers; they sum to `light`.
LightImage make_dot(const IVec2& size, const dvec2& position, double light) {
    LightImage image = oracle::make_black_image(size.x, size.y);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const dvec2 weight = glm::max(1.0 - glm::abs(dvec2(x, y) + 0.5 - position), 0.0);
            image.pixels[y * size.x + x] = dvec3(weight.x * weight.y * light);
        }
    }
    return image;
}

/// Energy conservation and symmetry of single points of light; `strength` 1, so that only scattered
/// light remains.
void measure_points(Bench& bench, QualityReport& report) {
    const Glow glow = {.strength = 1, .firefly = 0};
    double lost = 0;
    double spread = 0;
    for (const IVec2& size : {kSize, kOddSize}) {
        const dvec2 center = glm::floor(0.5 * dvec2(size)) + 0.5;
        for (const dvec2& position :
             {center, dvec2(0.5), dvec2(size.x - 0.5, 60.5), dvec2(size) - 0.5}) {
            const LightImage made = bench.with_glow(make_dot(size, position, 10), glow);
            lost = std::max(lost, percent_error(oracle::sum_of(made).y, 10));
        }
        for (const dvec2& offset : {dvec2(0), dvec2(3, 5), dvec2(10, -7)}) {
            const LightImage made = bench.with_glow(make_dot(size, center + offset, 10), glow);
            const double widest = static_cast<double>(glow.radius) * size.y;
            for (double radius = 1.5; radius < widest; radius *= 1.3) {
                spread = std::max(
                    spread, 100 * oracle::rotational_spread(made, center + offset, radius));
            }
        }
    }
    report.at_most("energy error", lost, 0.5, "%");
    report.at_most("rotational asymmetry of a point", spread, 5, "%");
}

/// A pixel-sized lamp that moves by eighths of a pixel, at a tenth of the firefly limit.
void measure_flicker(Bench& bench, QualityReport& report) {
    std::vector<double> sums;
    std::vector<double> halos;
    constexpr int kSteps = 32;
    for (int i = 0; i <= kSteps; ++i) {
        const dvec2 position = dvec2(160.5, 90.5) + dvec2(i, 0.5 * i) / 8.0;
        const LightImage made =
            bench.with_glow(make_dot(kSize, position, 10), {.strength = 1, .firefly = 100});
        sums.push_back(oracle::sum_of(made).y);
        double halo = 0;
        for (int y = 0; y < kSize.y; ++y) {
            for (int x = 0; x < kSize.x; ++x) {
                const bool outside = glm::distance(dvec2(x, y) + 0.5, position) > 8;
                halo += outside ? made.at(x, y).y : 0;
            }
        }
        halos.push_back(halo);
    }
    const auto deviation = [](const std::vector<double>& values) {
        double mean = 0;
        double squares = 0;
        for (const double value : values) {
            mean += value / static_cast<double>(values.size());
            squares += value * value / static_cast<double>(values.size());
        }
        return 100 * std::sqrt(std::max(squares - mean * mean, 0.0)) / mean;
    };
    report.at_most("flicker of a moving pixel, total light", deviation(sums), 2, "%");
    report.at_most("flicker of a moving pixel, its halo", deviation(halos), 2, "%");
}

void measure_broken(Bench& bench, QualityReport& report) {
    LightImage image = make_dot(kSize, {100.5, 50.5}, 10);
    image.pixels[60 * kSize.x + 70].x = std::numeric_limits<double>::quiet_NaN();
    image.pixels[61 * kSize.x + 170].y = std::numeric_limits<double>::infinity();
    const LightImage made = bench.with_glow(image, {.strength = 1});
    double broken = -2;
    for (const dvec3& pixel : made.pixels) {
        broken += std::isfinite(pixel.x + pixel.y + pixel.z) ? 0 : 1;
    }
    report.at_most("pixels contaminated by NaN or infinity", broken, 0);
}

/// Compares a level with the convolution of its radiance.
Status measure_level(
    HeadlessRenderer& headless, Bench& bench, const std::string& level, QualityReport& report) {
    // The firefly clamp is not a convolution: it is off here.
    const Glow glow = {.strength = 0.5f, .firefly = 0};
    const LevelView opened = LIMN_TRY(open_level_view(level, kSize));
    World& world = opened.stage->world;
    world.insert_resource(Glow{.strength = 0});
    const LightImage sharp =
        read_light_image(*render_frame(*headless.renderer, world, opened.view).radiance);
    world.insert_resource(glow);
    const LightImage made =
        read_light_image(*render_frame(*headless.renderer, world, opened.view).radiance);
    const std::vector<float> weights = glow_weights(glow, kSize.x, kSize.y);
    const LightImage exact =
        oracle::scatter(sharp, glow.strength, oracle::scattering_of_levels(weights));

    QualityImage image = {
        fmt::format("{}, strength {}", level, glow.strength),
        bench.tone_mapped(made, opened.exposure), bench.tone_mapped(exact, opened.exposure)};
    const double off = percent_error(oracle::sum_of(made).y, oracle::sum_of(sharp).y);
    report.at_most(fmt::format("{}: energy error", level), off, 0.5, "%");
    report.at_least(
        fmt::format("{}: display PSNR vs the oracle", level), psnr(image.oracle, image.effect), 40,
        "dB");
    report.inform(
        fmt::format("{}: the same without glow", level),
        psnr(image.oracle, bench.tone_mapped(sharp, opened.exposure)), "dB");
    report.images.push_back(std::move(image));
    return Done{};
}

// ---- glare

// Standard deviation of a line drawn at half resolution [px]: downsampling, bilinear reads and
// upsampling contribute variances of 0.25, 0.5 .. 1.6 and 0.75.
constexpr double kLineWidth = 1.45;
constexpr double kTurn = 6.283185307179586;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

oracle::Star star_of(const Glare& glare) {
    return {
        .strength = glare.strength,
        .threshold = glare.threshold,
        .lines = glare.blades % 2 == 0 ? glare.blades / 2 : glare.blades,
        .rotation = glare.rotation,
        .length = static_cast<double>(glare.length) * kSize.y};
}

/// The light added to an image, and its centroid.
struct Added {
    LightImage light;
    dvec2 centroid = dvec2(0);
    double sum = 0;  ///< of green
};

Added added_to(const LightImage& before, LightImage after) {
    Added added;
    for (int y = 0; y < after.height; ++y) {
        for (int x = 0; x < after.width; ++x) {
            dvec3& pixel = after.pixels[y * after.width + x];
            pixel -= before.at(x, y);
            added.sum += pixel.y;
            added.centroid += pixel.y * (dvec2(x, y) + 0.5);
        }
    }
    added.centroid /= added.sum;
    added.light = std::move(after);
    return added;
}

/// Green channel, bilinear.
double light_at(const LightImage& image, const dvec2& position) {
    const dvec2 corner = glm::floor(position - 0.5);
    const dvec2 fraction = position - 0.5 - corner;
    const auto at = [&](int i, int j) {
        return image.at(static_cast<int>(corner.x) + i, static_cast<int>(corner.y) + j).y;
    };
    return (1 - fraction.y) * ((1 - fraction.x) * at(0, 0) + fraction.x * at(1, 0))
           + fraction.y * ((1 - fraction.x) * at(0, 1) + fraction.x * at(1, 1));
}

/// Direction in the image, whose rows run downward.
dvec2 direction(double angle) {
    return {std::cos(angle), -std::sin(angle)};
}

/// Angles of the streaks: centroids of the peaks of the light at radii `low` .. `high` [px].
std::vector<double> streak_angles(const Added& added, double low, double high) {
    constexpr int kAngles = 1440;
    std::vector<double> light(kAngles);
    for (int i = 0; i < kAngles; ++i) {
        for (double radius = low; radius < high; radius += 0.5) {
            const dvec2 offset = radius * direction(kTurn * i / kAngles);
            light[i] += radius * light_at(added.light, added.centroid + offset);
        }
    }
    const double level = 0.4 * *std::max_element(light.begin(), light.end());
    std::vector<double> angles;
    for (int begin = 0; begin < kAngles; ++begin) {
        if (light[begin] > level && light[(begin + kAngles - 1) % kAngles] <= level) {
            double weight = 0;
            double mean = 0;
            for (int i = begin; light[i % kAngles] > level && i < begin + kAngles; ++i) {
                weight += light[i % kAngles];
                mean += i * light[i % kAngles];
            }
            angles.push_back(kTurn * std::fmod(mean / weight, kAngles) / kAngles);
        }
    }
    return angles;
}

/// Largest angular error of a streak against diffraction [degrees]; infinite if their counts
/// differ.
double angles_off(const std::vector<double>& found, const std::vector<double>& exact) {
    if (found.size() != exact.size()) {
        return kInfinity;
    }
    double worst = 0;
    for (const double angle : exact) {
        double nearest = kTurn;
        for (const double other : found) {
            const double apart = std::abs(std::remainder(angle - other, kTurn));
            nearest = std::min(nearest, apart);
        }
        worst = std::max(worst, nearest);
    }
    return worst * 360 / kTurn;
}

void measure_streaks(Bench& bench, QualityReport& report) {
    const LightImage lamp = make_dot(kSize, {160.5, 90.5}, 1e4);
    double worst = 0;
    for (int blades = 3; blades <= 9; ++blades) {
        const Glare glare = {
            .strength = 1, .threshold = 1, .blades = blades, .length = 0.45f, .rotation = 0.2f};
        const Added added = added_to(lamp, bench.with_glare(lamp, glare));
        worst = std::max(
            worst, angles_off(
                       streak_angles(added, 20, 44),
                       oracle::diffraction_angles(blades, static_cast<double>(glare.rotation))));
    }
    report.at_most("glare: angular error of the streaks of 3 to 9 blades", worst, 1, "degrees");
}

/// Light across a streak at `distance` [px] from the lamp, the mean of both sides.
double crossing_light(const Added& added, double angle, double distance) {
    constexpr double kHalfWidth = 7;  // across the line [px]
    constexpr double kStep = 0.25;
    const dvec2 along = direction(angle);
    const dvec2 across = direction(angle + 0.25 * kTurn);
    double sum = 0;
    for (double beside = -kHalfWidth; beside <= kHalfWidth; beside += kStep) {
        for (const double side : {-1.0, 1.0}) {
            sum +=
                0.5 * kStep
                * light_at(added.light, added.centroid + side * distance * along + beside * across);
        }
    }
    return sum;
}

/// line_density(), blurred along the line by the line's width.
double blurred_density(double distance, double length) {
    constexpr double kStep = 0.05;  // in deviations
    double sum = 0;
    double whole = 0;
    for (double at = -4; at <= 4; at += kStep) {
        const double weight = std::exp(-0.5 * at * at);
        sum += weight * oracle::line_density(distance + at * kLineWidth, length);
        whole += weight;
    }
    return sum / whole;
}

void measure_profile(Bench& bench, QualityReport& report) {
    const LightImage lamp = make_dot(kSize, {160.5, 90.5}, 1e4);
    double lost = 0;
    double profile = 0;
    double power = 0;
    for (const float rotation : {0.0f, 0.3f, 0.6f}) {
        const Glare glare = {
            .strength = 0.5f, .threshold = 2, .blades = 4, .length = 0.4f, .rotation = rotation};
        const Added added = added_to(lamp, bench.with_glare(lamp, glare));
        const oracle::Star star = star_of(glare);
        const double whole = star.strength * (1e4 - star.threshold);
        lost = std::max(lost, percent_error(added.sum, whole));
        const auto density = [&](double distance) {
            return crossing_light(added, star.rotation, distance) * star.lines / whole;
        };
        double off = 0;
        double all = 0;
        for (double distance = 6; distance < star.length; distance += 0.5) {
            const double exact = blurred_density(distance, star.length);
            off += std::abs(density(distance) - exact);
            all += exact;
        }
        profile = std::max(profile, 100 * off / all);
        const double far = 0.3 * star.length;
        power = std::max(power, std::abs(std::log2(density(0.5 * far) / density(far)) - 2));
    }
    report.at_most("glare: energy error of a star", lost, 1, "%");
    report.at_most("glare: error of the profile along a streak", profile, 5, "%");
    report.at_most("glare: error of the fall-off exponent, from 2", power, 0.3);
}

/// Compares an image with stars with the oracle's.
void compare_stars(
    Bench& bench, const std::string& name, const LightImage& sharp, const Glare& glare,
    const Exposure& exposure, QualityReport& report) {
    const LightImage exact = oracle::add_stars(sharp, star_of(glare), kLineWidth);
    QualityImage image = {
        fmt::format("glare: {}, {} blades", name, glare.blades),
        bench.tone_mapped(bench.with_glare(sharp, glare), exposure),
        bench.tone_mapped(exact, exposure)};
    // At half resolution, lines are up to half a pixel off their lamps.
    constexpr double kMinPsnr = 36;
    report.at_least(
        fmt::format("glare: {}, display PSNR vs the oracle", name),
        psnr(image.oracle, image.effect), kMinPsnr, "dB");
    report.inform(
        fmt::format("glare: {}, the same without glare", name),
        psnr(image.oracle, bench.tone_mapped(sharp, exposure)), "dB");
    report.images.push_back(std::move(image));
}

Status measure_glare(HeadlessRenderer& headless, Bench& bench, QualityReport& report) {
    measure_streaks(bench, report);
    measure_profile(bench, report);

    LightImage lamps = make_dot(kSize, {70.5, 60.5}, 400);
    lamps.pixels[110 * kSize.x + 160] = {900, 300, 60};
    lamps.pixels[50 * kSize.x + 250] = {80, 300, 900};
    lamps.pixels[140 * kSize.x + 90] = {0.9, 0.9, 0.9};
    compare_stars(bench, "lamps", lamps, {.strength = 1, .blades = 6, .length = 0.4f}, {}, report);
    compare_stars(bench, "odd lamps", lamps, {.strength = 1, .blades = 5}, {}, report);
    const LevelView level = LIMN_TRY(open_level_view("lights", kSize));
    World& world = level.stage->world;
    world.insert_resource(Glow{.strength = 0});
    const LightImage sharp =
        read_light_image(*render_frame(*headless.renderer, world, level.view).radiance);
    compare_stars(bench, "lights", sharp, {.strength = 0.5f}, level.exposure, report);
    return Done{};
}

Status measure_glow(HeadlessRenderer& headless, QualityReport& report) {
    gpu::Device& device = *headless.device;
    Bench bench(
        device, LIMN_TRY(create_tone_mapper(device)), LIMN_TRY(create_glow_pass(device)),
        LIMN_TRY(create_glare_pass(device)));
    measure_points(bench, report);
    measure_flicker(bench, report);
    measure_broken(bench, report);
    for (const char* level : {"lights", "gallery"}) {
        LIMN_TRY(measure_level(headless, bench, level, report));
    }
    return measure_glare(headless, bench, report);
}

const RegisterQuality
    kRegistered("glow", "a convolution in double precision, and energy conservation", measure_glow);

}  // namespace
}  // namespace limn::glow_quality
