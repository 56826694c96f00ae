#include "content/app/quality_dof.h"

#include "bench/oracles/lens_oracle.h"
#include "bench/oracles/motion_blur_oracle.h"
#include "content/app/quality_court.h"
#include "content/app/quality_scene.h"
#include "content/make/shapes.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "render/render_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kSamples = 256;
constexpr float kFovY = 0.6f;
constexpr float kFilm = 0.024f;
constexpr float kFNumber = 0.5f;
constexpr float kFocus = 2;  ///< [m]

const Camera kCamera = {.fov_y = kFovY, .near = 0.05f};

RenderView lens_view(const Vec3& eye, const Vec3& target, const Lens& lens) {
    RenderView view = quality_view(eye, target, kWidth, kHeight, kFovY);
    view.lens = *make_lens_view(lens, kCamera);
    return view;
}

/// The lens that most is measured with, looking along -z.
RenderView fast_view() {
    return lens_view(
        {0, 0, 0}, {0, 0, -1},
        {.f_number = kFNumber,
         .focus_distance = kFocus,
         .sensor_height = kFilm,
         .largest_blur = 0.25f});
}

gpu::FloatImage picture(HeadlessRenderer& headless, QualityScene& scene, const RenderView& view) {
    return gpu::read_floats(*render_frame(*headless.renderer, scene.world, view).radiance);
}

/// The mean of what many points of the lens see.
gpu::FloatImage sampled(HeadlessRenderer& headless, QualityScene& scene, const RenderView& view) {
    oracle::MeanPicture mean;
    for (int i = 0; i < kSamples; ++i) {
        const oracle::LensPoint point = oracle::lens_point(i, kSamples);
        const Vec2 place = {static_cast<float>(point.x), static_cast<float>(point.y)};
        mean.add(picture(headless, scene, with_lens_sample(view, place)));
    }
    return mean.mean();
}

gpu::FloatImage sharp(HeadlessRenderer& headless, QualityScene& scene, RenderView view) {
    view.lens.aperture_radius = 0;
    return picture(headless, scene, view);
}

MaterialId shining(QualityScene& scene, const Vec3& light) {
    return scene.add(
        Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}, .emission = light});
}

/// Width of a pixel at `distance` [m].
float pixel_at(float distance) {
    return 2 * distance * std::tan(0.5f * kFovY) / kHeight;
}

// ---- discs

struct Moments {
    double light = 0;
    double variance = 0;  ///< along an axis [px^2]
};

Moments moments_of(const gpu::FloatImage& image) {
    double sum[5] = {};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double light = static_cast<double>(image.at(x, y, 0));
            const double terms[5] = {1, double(x), double(y), double(x) * x, double(y) * y};
            for (int i = 0; i < 5; ++i) {
                sum[i] += light * terms[i];
            }
        }
    }
    const double x = sum[1] / sum[0];
    const double y = sum[2] / sum[0];
    return {sum[0], 0.5 * (sum[3] / sum[0] - x * x + sum[4] / sum[0] - y * y)};
}

/// Of the even disc that spreads what `from` is as far as `to`.
double disc_diameter(const Moments& from, const Moments& to) {
    return 4 * std::sqrt(std::max(to.variance - from.variance, 0.0));
}

/// A lamp of 2 x 2 px, on a dark wall or before the night.
void furnish_lamp(QualityScene& scene, float distance, bool wall) {
    const MeshId square = scene.add(quality_square());
    const float pixel = pixel_at(distance);
    scene.place(
        square, shining(scene, Vec3(500)), placed_at({3 * pixel, -4 * pixel, -distance}, pixel));
    if (wall) {
        const float behind = 1.0001f * distance;
        scene.place(square, shining(scene, Vec3(0)), placed_at({0, 0, -behind}, 300 * pixel));
    }
}

/// How far discs are from the law, at worst.
struct DiscErrors {
    double diameter = 0;  ///< [px]
    double light = 0;
    double samples = 0;  ///< the diameter of the truth [px]
};

DiscErrors measure_discs(HeadlessRenderer& headless, bool wall, QualityReport& report) {
    const oracle::ThinLens lens = oracle::lens_of_camera(
        static_cast<double>(kFovY), static_cast<double>(kFilm), double(kFNumber), double(kFocus));
    const RenderView view = fast_view();
    DiscErrors errors;
    for (const double distance : {0.7, 0.85, 1.0, 1.15, 1.3, 1.5, 2.6, 3.0, 4.0, 6.0, 10.0, 30.0}) {
        QualityScene scene;
        furnish_lamp(scene, static_cast<float>(distance), wall);
        const Moments point = moments_of(sharp(headless, scene, view));
        const gpu::FloatImage effect = picture(headless, scene, view);
        const Moments disc = moments_of(effect);
        const double wanted =
            oracle::image_diameter(lens, distance) / static_cast<double>(kFilm) * kHeight;
        const double found = disc_diameter(point, disc);
        errors.diameter = std::max(errors.diameter, std::abs(found - wanted));
        errors.light = std::max(errors.light, std::abs(disc.light / point.light - 1));
        if (wall) {
            report.rows.push_back(
                {fmt::format("disc at {} m, diameter ({:.2f} px by the law)", distance, wanted),
                 found, QualityBound::None, 0, "px"});
        }
        if (wall && (distance == 0.7 || distance == 30.0)) {
            const gpu::FloatImage truth = sampled(headless, scene, view);
            const double its = disc_diameter(point, moments_of(truth));
            errors.samples = std::max(errors.samples, std::abs(its - wanted));
            report.pictures.push_back(
                {fmt::format("a lamp at {} m", distance), displayed(effect), displayed(truth)});
        }
    }
    return errors;
}

void measure_law(HeadlessRenderer& headless, QualityReport& report) {
    const DiscErrors wall = measure_discs(headless, true, report);
    const DiscErrors night = measure_discs(headless, false, report);
    const QualityRow rows[] = {
        {"largest difference from the diameter law", wall.diameter, QualityBound::AtMost, 0.5,
         "px"},
        {"the same of the 256 samples themselves", wall.samples, QualityBound::None, 0, "px"},
        {"light that a disc gains or loses", 100 * wall.light, QualityBound::AtMost, 1, "%"},
        {"difference from the law, of lamps before the night", night.diameter, QualityBound::AtMost,
         0.5, "px"},
        {"light that those gain or lose", 100 * night.light, QualityBound::AtMost, 2, "%"}};
    report.rows.insert(report.rows.end(), std::begin(rows), std::end(rows));
}

// ---- edges

/// A bright card of 54 x 54 px before a dark wall.
void furnish_card(QualityScene& scene, float distance, float wall) {
    const MeshId square = scene.add(quality_square());
    scene.place(
        square, shining(scene, Vec3(1)), placed_at({0, 0, -distance}, 27 * pixel_at(distance)));
    scene.place(square, shining(scene, Vec3(0)), placed_at({0, 0, -wall}, 2 * wall));
}

/// What of a sharp card reaches pixels that do not show it.
void measure_leak(HeadlessRenderer& headless, QualityReport& report) {
    QualityScene scene;
    furnish_card(scene, kFocus, 40);
    const RenderView view = fast_view();
    const gpu::FloatImage without = sharp(headless, scene, view);
    const gpu::FloatImage with = picture(headless, scene, view);
    double leak = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            if (without.at(x, y, 0) == 0) {
                leak = std::max(leak, static_cast<double>(with.at(x, y, 0)));
            }
        }
    }
    report.rows.push_back({"what is sharp leaks", 255 * leak, QualityBound::AtMost, 2, "/ 255"});
}

/// What of a near card lies outside its outline.
void measure_spread(HeadlessRenderer& headless, QualityReport& report) {
    QualityScene scene;
    furnish_card(scene, 1.2f, kFocus);
    const RenderView view = fast_view();
    const gpu::FloatImage without = sharp(headless, scene, view);
    const auto outside = [&](const gpu::FloatImage& image) {
        double sum = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                sum += without.at(x, y, 0) == 0 ? static_cast<double>(image.at(x, y, 0)) : 0;
            }
        }
        return sum;
    };
    const gpu::FloatImage truth = sampled(headless, scene, view);
    const gpu::FloatImage effect = picture(headless, scene, view);
    report.rows.push_back(
        {"light outside the outline of a near card, from that of the samples",
         100 * std::abs(outside(effect) / outside(truth) - 1), QualityBound::AtMost, 5, "%"});
    report.pictures.push_back({"a near card", displayed(effect), displayed(truth)});
}

// ---- scenes

void light_up(QualityScene& scene) {
    scene.world.insert_resource(Environment{
        .sky = SkyKind::Gradient,
        .zenith = {0.25f, 0.4f, 0.75f},
        .horizon = {0.75f, 0.8f, 0.85f},
        .ground = {0.2f, 0.19f, 0.17f}});
    scene.shine(
        DirectionalLight{.color = {1, 0.95f, 0.85f}, .illuminance = 2},
        look_at({0, 0, 0}, {-0.4f, -1, -0.6f}));
}

/// Lamps in the night behind a ball, and a post before it.
void furnish_night(QualityScene& scene) {
    scene.shine(
        PointLight{.color = {1, 0.9f, 0.8f}, .intensity = 20, .radius = 20}, placed_at({2, 3, 1}));
    const MeshId ball = scene.add(make_sphere({.radius = 1, .segments = 48, .rings = 24}));
    const MaterialId red = scene.add(Material{.base_color = {0.7f, 0.15f, 0.1f, 1}});
    const MaterialId green = scene.add(Material{.base_color = {0.15f, 0.5f, 0.25f, 1}});
    const MaterialId gray = scene.add(Material{.base_color = {0.4f, 0.4f, 0.42f, 1}});
    scene.place(ball, red, placed_at({0.1f, 0.05f, -2}, 0.22f));
    scene.place(
        scene.add(make_box({.size = {0.05f, 2, 0.05f}})), green, placed_at({-0.28f, 0, -1.3f}));
    scene.place(scene.add(make_box({.size = {20, 0.1f, 20}})), gray, placed_at({0, -0.5f, -8}));
    for (int i = 0; i < 24; ++i) {
        const auto share = [i](float step) {
            const float x = step * static_cast<float>(i + 1);
            return x - std::floor(x);
        };
        const float z = -5 - 7 * share(0.7549f);
        const Vec3 place = {-z * 0.9f * (share(0.5698f) - 0.5f), -z * 0.3f * share(0.3819f), z};
        const Vec3 light = i % 3 == 0   ? Vec3(90, 45, 12)
                           : i % 3 == 1 ? Vec3(15, 40, 90)
                                        : Vec3(80, 20, 50);
        scene.place(ball, shining(scene, light), placed_at(place, 0.03f));
    }
}

void measure_scene(
    HeadlessRenderer& headless, QualityScene& scene, const RenderView& view, const char* name,
    QualityReport& report) {
    const ColorImage truth = displayed(sampled(headless, scene, view));
    ColorImage effect = displayed(picture(headless, scene, view));
    RenderView by_levels = view;
    by_levels.lens.method = FocusMethod::Mip;
    const struct {
        const char* what;
        double found;
    } rows[] = {
        {"PSNR", psnr(effect, truth)},
        {"PSNR by mip levels", psnr(displayed(picture(headless, scene, by_levels)), truth)},
        {"PSNR of the sharp picture", psnr(displayed(sharp(headless, scene, view)), truth)}};
    for (const auto& row : rows) {
        report.rows.push_back(
            {fmt::format("{}, {}", name, row.what), row.found, QualityBound::None, 0, "dB"});
    }
    report.pictures.push_back({name, std::move(effect), truth});
}

}  // namespace

Result<QualityReport> measure_dof(HeadlessRenderer& headless) {
    QualityReport report;
    measure_law(headless, report);
    measure_leak(headless, report);
    measure_spread(headless, report);
    {
        QualityScene night;
        furnish_night(night);
        measure_scene(headless, night, fast_view(), "lamps behind a ball", report);
    }
    QualityScene court;
    light_up(court);
    furnish_court(court);
    const Lens lens = {.f_number = 0.35f, .focus_distance = 6.5f, .sensor_height = kFilm};
    const RenderView view = lens_view({1.7f, 2.5f, 4.4f}, {-0.25f, 0.75f, -0.6f}, lens);
    measure_scene(headless, court, view, "court", report);
    return report;
}

}  // namespace limn
