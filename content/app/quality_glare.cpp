#include "content/app/quality_glare.h"

#include "bench/oracles/glare_oracle.h"
#include "content/app/quality_light.h"
#include "ecs/components/glare.h"
#include "ecs/components/glow.h"
#include "ecs/world.h"
#include "render/passes/glare_pass.h"
#include "render/render_frame.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace limn {
namespace {

using glm::dvec2;
using glm::dvec3;
using oracle::LightPicture;

constexpr IVec2 kSize = {320, 180};
// Deviation of a line that is drawn at half the size [px]: means of four pixels, readings between
// texels and showing half as many of them have variances of 0.25, 0.5 .. 1.6 and 0.75.
constexpr double kWidth = 1.45;
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

class GlareBench {
  public:
    GlareBench(gpu::Device& device, GlarePass pass, Developer developer)
        : graph_(device), pass_(std::move(pass)), developer_(std::move(developer)) {}

    LightPicture glaring(const LightPicture& picture, const Glare& glare) {
        const gpu::Texture radiance = upload_light(picture);
        graph_.begin_frame();
        const TextureId made =
            draw_glare(graph_, pass_, glare, graph_.import("radiance", radiance));
        graph_.keep(made);
        graph_.execute();
        return light_picture(*graph_.texture(made));
    }
    ColorImage developed(const LightPicture& picture, const Exposure& exposure) {
        return develop_light(graph_, developer_, picture, exposure);
    }

  private:
    FrameGraph graph_;
    GlarePass pass_;
    Developer developer_;
};

/// What was added to a picture, and the middle of that.
struct Added {
    LightPicture light;
    dvec2 middle = dvec2(0);
    double sum = 0;  ///< of green
};

Added added_to(const LightPicture& before, LightPicture after) {
    Added added;
    for (int y = 0; y < after.height; ++y) {
        for (int x = 0; x < after.width; ++x) {
            dvec3& pixel = after.pixels[y * after.width + x];
            pixel -= before.at(x, y);
            added.sum += pixel.y;
            added.middle += pixel.y * (dvec2(x, y) + 0.5);
        }
    }
    added.middle /= added.sum;
    added.light = std::move(after);
    return added;
}

/// Of green, between pixels.
double light_at(const LightPicture& picture, const dvec2& place) {
    const dvec2 corner = glm::floor(place - 0.5);
    const dvec2 share = place - 0.5 - corner;
    const auto at = [&](int i, int j) {
        return picture.at(static_cast<int>(corner.x) + i, static_cast<int>(corner.y) + j).y;
    };
    return (1 - share.y) * ((1 - share.x) * at(0, 0) + share.x * at(1, 0))
           + share.y * ((1 - share.x) * at(0, 1) + share.x * at(1, 1));
}

/// In the picture, whose rows go down.
dvec2 direction(double angle) {
    return {std::cos(angle), -std::sin(angle)};
}

/// Angles of the streaks: middles of the peaks of the light from `low` to `high` away.
std::vector<double> streak_angles(const Added& added, double low, double high) {
    constexpr int kAngles = 1440;
    std::vector<double> light(kAngles);
    for (int i = 0; i < kAngles; ++i) {
        for (double radius = low; radius < high; radius += 0.5) {
            const dvec2 way = radius * direction(kTurn * i / kAngles);
            light[i] += radius * light_at(added.light, added.middle + way);
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

/// Farthest that a streak is from where diffraction has one [degrees]; infinite if there are not
/// as many.
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

void measure_streaks(GlareBench& bench, QualityReport& report) {
    const LightPicture lamp = make_dot(kSize, {160.5, 90.5}, 1e4);
    double worst = 0;
    for (int blades = 3; blades <= 9; ++blades) {
        const Glare glare = {
            .strength = 1, .threshold = 1, .blades = blades, .length = 0.45f, .rotation = 0.2f};
        const Added added = added_to(lamp, bench.glaring(lamp, glare));
        worst = std::max(
            worst, angles_off(
                       streak_angles(added, 20, 44),
                       oracle::diffraction_angles(blades, static_cast<double>(glare.rotation))));
    }
    report.rows.push_back(
        {"glare: streaks, from where 3 to 9 blades diffract light", worst, QualityBound::AtMost, 1,
         "degrees"});
}

/// The light about a line `distance` [px] from the lamp, on both of its sides.
double crossing_light(const Added& added, double angle, double distance) {
    constexpr double kReach = 7;  // beside the line [px]
    constexpr double kStep = 0.25;
    const dvec2 along = direction(angle);
    const dvec2 across = direction(angle + 0.25 * kTurn);
    double sum = 0;
    for (double beside = -kReach; beside <= kReach; beside += kStep) {
        for (const double side : {-1.0, 1.0}) {
            sum +=
                0.5 * kStep
                * light_at(added.light, added.middle + side * distance * along + beside * across);
        }
    }
    return sum;
}

/// line_density(), along the line as wide as across it.
double blurred_density(double distance, double length) {
    constexpr double kStep = 0.05;  // in deviations
    double sum = 0;
    double whole = 0;
    for (double at = -4; at <= 4; at += kStep) {
        const double weight = std::exp(-0.5 * at * at);
        sum += weight * oracle::line_density(distance + at * kWidth, length);
        whole += weight;
    }
    return sum / whole;
}

void measure_profile(GlareBench& bench, QualityReport& report) {
    const LightPicture lamp = make_dot(kSize, {160.5, 90.5}, 1e4);
    double lost = 0;
    double profile = 0;
    double power = 0;
    for (const float rotation : {0.0f, 0.3f, 0.6f}) {
        const Glare glare = {
            .strength = 0.5f, .threshold = 2, .blades = 4, .length = 0.4f, .rotation = rotation};
        const Added added = added_to(lamp, bench.glaring(lamp, glare));
        const oracle::Star star = star_of(glare);
        const double whole = star.strength * (1e4 - star.threshold);
        lost = std::max(lost, percent_off(added.sum, whole));
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
    report.rows.push_back(
        {"glare: light of a star, from what was asked", lost, QualityBound::AtMost, 1, "%"});
    report.rows.push_back(
        {"glare: light along a streak, from its closed form", profile, QualityBound::AtMost, 5,
         "%"});
    report.rows.push_back(
        {"glare: power of the distance that it falls with, from 2", power, QualityBound::AtMost,
         0.3, ""});
}

/// A picture with stars beside that of the oracle.
void compare_stars(
    GlareBench& bench, const std::string& name, const LightPicture& sharp, const Glare& glare,
    const Exposure& exposure, QualityReport& report) {
    const LightPicture exact = oracle::add_stars(sharp, star_of(glare), kWidth);
    QualityPicture picture = {
        fmt::format("glare: {}, {} blades", name, glare.blades),
        bench.developed(bench.glaring(sharp, glare), exposure), bench.developed(exact, exposure)};
    report.rows.push_back(
        {fmt::format("glare: {}, as shown, beside the oracle", name),
         psnr(picture.oracle, picture.effect), QualityBound::AtLeast,
         36,  // at half the size lines are up to half a pixel beside their lamps
         "dB"});
    report.rows.push_back(
        {fmt::format("glare: {}, the same without it", name),
         psnr(picture.oracle, bench.developed(sharp, exposure)), QualityBound::None, 0, "dB"});
    report.pictures.push_back(std::move(picture));
}

}  // namespace

Status measure_glare(HeadlessRenderer& headless, QualityReport& report) {
    Result<GlarePass> pass = create_glare_pass(*headless.device);
    if (!pass) {
        return pass.error();
    }
    Result<Developer> developer = create_developer(*headless.device);
    if (!developer) {
        return developer.error();
    }
    GlareBench bench(*headless.device, *std::move(pass), *std::move(developer));
    measure_streaks(bench, report);
    measure_profile(bench, report);

    LightPicture lamps = make_dot(kSize, {70.5, 60.5}, 400);
    lamps.pixels[110 * kSize.x + 160] = {900, 300, 60};
    lamps.pixels[50 * kSize.x + 250] = {80, 300, 900};
    lamps.pixels[140 * kSize.x + 90] = {0.9, 0.9, 0.9};
    compare_stars(bench, "lamps", lamps, {.strength = 1, .blades = 6, .length = 0.4f}, {}, report);
    compare_stars(bench, "odd lamps", lamps, {.strength = 1, .blades = 5}, {}, report);
    Result<LevelView> level = open_level_view("lights", kSize);
    if (!level) {
        return level.error();
    }
    World& world = level->stage->world;
    world.insert_resource(Glow{.strength = 0});
    const LightPicture sharp =
        light_picture(*render_frame(*headless.renderer, world, level->view).radiance);
    compare_stars(bench, "lights", sharp, {.strength = 0.5f}, level->exposure, report);
    return Done{};
}

}  // namespace limn
