#include "content/app/quality_glow.h"

#include "bench/oracles/glow_oracle.h"
#include "content/app/quality_glare.h"
#include "content/app/quality_light.h"
#include "ecs/components/glow.h"
#include "ecs/world.h"
#include "render/passes/glow_pass.h"
#include "render/render_frame.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn {
namespace {

using glm::dvec2;
using glm::dvec3;
using oracle::LightPicture;

constexpr IVec2 kEven = {320, 180};
constexpr IVec2 kOdd = {321, 179};

/// What the renderer makes of pictures that no scene shows.
class Bench {
  public:
    Bench(HeadlessRenderer& headless, GlowPass pass, Developer developer)
        : graph_(*headless.device), pass_(pass), developer_(std::move(developer)) {}

    LightPicture glowing(const LightPicture& picture, const Glow& glow) {
        const gpu::Texture radiance = upload_light(picture);
        graph_.begin_frame();
        const TextureId made = draw_glow(graph_, pass_, glow, graph_.import("radiance", radiance));
        graph_.keep(made);
        graph_.execute();
        return light_picture(*graph_.texture(made));
    }

    ColorImage developed(const LightPicture& picture, const Exposure& exposure) {
        return develop_light(graph_, developer_, picture, exposure);
    }

  private:
    FrameGraph graph_;
    GlowPass pass_;
    Developer developer_;
};

/// The laws, by single points of light; `strength` 1, so that nothing hides what the glow does.
void measure_points(Bench& bench, QualityReport& report) {
    const Glow glow = {.strength = 1, .firefly = 0};
    double lost = 0;
    double spread = 0;
    for (const IVec2& size : {kEven, kOdd}) {
        const dvec2 center = glm::floor(0.5 * dvec2(size)) + 0.5;
        for (const dvec2& place :
             {center, dvec2(0.5), dvec2(size.x - 0.5, 60.5), dvec2(size) - 0.5}) {
            const LightPicture made = bench.glowing(make_dot(size, place, 10), glow);
            lost = std::max(lost, percent_off(oracle::sum_of(made).y, 10));
        }
        for (const dvec2& offset : {dvec2(0), dvec2(3, 5), dvec2(10, -7)}) {
            const LightPicture made = bench.glowing(make_dot(size, center + offset, 10), glow);
            const double widest = static_cast<double>(glow.radius) * size.y;
            for (double radius = 1.5; radius < widest; radius *= 1.3) {
                spread = std::max(
                    spread, 100 * oracle::rotational_spread(made, center + offset, radius));
            }
        }
    }
    report.rows.push_back({"light made or lost", lost, QualityBound::AtMost, 0.5, "%"});
    report.rows.push_back({"rotational spread of a point", spread, QualityBound::AtMost, 5, "%"});
}

/// A lamp as large as a pixel, which moves by eighths of one; no firefly, but a tenth of one.
void measure_flicker(Bench& bench, QualityReport& report) {
    std::vector<double> sums;
    std::vector<double> halos;
    constexpr int kSteps = 32;
    for (int i = 0; i <= kSteps; ++i) {
        const dvec2 place = dvec2(160.5, 90.5) + dvec2(i, 0.5 * i) / 8.0;
        const LightPicture made =
            bench.glowing(make_dot(kEven, place, 10), {.strength = 1, .firefly = 100});
        sums.push_back(oracle::sum_of(made).y);
        double halo = 0;
        for (int y = 0; y < kEven.y; ++y) {
            for (int x = 0; x < kEven.x; ++x) {
                const bool outside = glm::distance(dvec2(x, y) + 0.5, place) > 8;
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
    report.rows.push_back(
        {"flicker of a moving pixel, all light", deviation(sums), QualityBound::AtMost, 2, "%"});
    report.rows.push_back(
        {"flicker of a moving pixel, its halo", deviation(halos), QualityBound::AtMost, 2, "%"});
}

void measure_broken(Bench& bench, QualityReport& report) {
    LightPicture picture = make_dot(kEven, {100.5, 50.5}, 10);
    picture.pixels[60 * kEven.x + 70].x = std::numeric_limits<double>::quiet_NaN();
    picture.pixels[61 * kEven.x + 170].y = std::numeric_limits<double>::infinity();
    const LightPicture made = bench.glowing(picture, {.strength = 1});
    double broken = -2;
    for (const dvec3& pixel : made.pixels) {
        broken += std::isfinite(pixel.x + pixel.y + pixel.z) ? 0 : 1;
    }
    report.rows.push_back(
        {"pixels that NaN or infinity spreads to", broken, QualityBound::AtMost, 0, ""});
}

/// A level beside the convolution of its radiance.
Status measure_level(
    HeadlessRenderer& headless, Bench& bench, const std::string& level, QualityReport& report) {
    // Fireflies are held back, which is no convolution: here they are let through.
    const Glow glow = {.strength = 0.5f, .firefly = 0};
    Result<LevelView> opened = open_level_view(level, kEven);
    if (!opened) {
        return opened.error();
    }
    World& world = opened->stage->world;
    world.insert_resource(Glow{.strength = 0});
    const LightPicture sharp =
        light_picture(*render_frame(*headless.renderer, world, opened->view).radiance);
    world.insert_resource(glow);
    const LightPicture made =
        light_picture(*render_frame(*headless.renderer, world, opened->view).radiance);
    const std::vector<float> weights = glow_weights(glow, kEven.x, kEven.y);
    const LightPicture exact =
        oracle::scatter(sharp, glow.strength, oracle::scattering_of_levels(weights));

    QualityPicture picture = {
        fmt::format("{}, strength {}", level, glow.strength),
        bench.developed(made, opened->exposure), bench.developed(exact, opened->exposure)};
    const double off = percent_off(oracle::sum_of(made).y, oracle::sum_of(sharp).y);
    report.rows.push_back(
        {fmt::format("{}: light made or lost", level), off, QualityBound::AtMost, 0.5, "%"});
    report.rows.push_back(
        {fmt::format("{}: as shown, beside the oracle", level),
         psnr(picture.oracle, picture.effect), QualityBound::AtLeast, 40, "dB"});
    report.rows.push_back(
        {fmt::format("{}: the same without glow", level),
         psnr(picture.oracle, bench.developed(sharp, opened->exposure)), QualityBound::None, 0,
         "dB"});
    report.pictures.push_back(std::move(picture));
    return Done{};
}

}  // namespace

Result<QualityReport> measure_glow(HeadlessRenderer& headless) {
    Result<GlowPass> pass = create_glow_pass(*headless.device);
    if (!pass) {
        return pass.error();
    }
    Result<Developer> developer = create_developer(*headless.device);
    if (!developer) {
        return developer.error();
    }
    Bench bench(headless, *pass, *std::move(developer));
    QualityReport report;
    measure_points(bench, report);
    measure_flicker(bench, report);
    measure_broken(bench, report);
    for (const char* level : {"lights", "gallery"}) {
        if (const Status status = measure_level(headless, bench, level, report); !status) {
            return status.error();
        }
    }
    if (const Status status = measure_glare(headless, report); !status) {
        return status.error();
    }
    return report;
}

}  // namespace limn
