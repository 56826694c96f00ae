#include "bench/oracles/lens_oracle.h"
#include "bench/oracles/motion_blur_oracle.h"
#include "bench/quality/quality_scene.h"
#include "content/make/models/shapes.h"
#include "ecs/components/light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn::dof_quality {
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

/// The lens of most measurements, looking along -z.
RenderView fast_view() {
    return lens_view(
        {0, 0, 0}, {0, 0, -1},
        {.f_number = kFNumber,
         .focus_distance = kFocus,
         .sensor_height = kFilm,
         .max_blur = 0.25f});
}

/// The mean of views from many points on the lens.
gpu::FloatImage sampled(HeadlessRenderer& headless, QualityScene& scene, const RenderView& view) {
    oracle::MeanImage mean;
    for (int i = 0; i < kSamples; ++i) {
        const oracle::LensPoint point = oracle::lens_point(i, kSamples);
        const Vec2 on_lens = {static_cast<float>(point.x), static_cast<float>(point.y)};
        mean.add(scene.render(headless, with_lens_sample(view, on_lens)));
    }
    return mean.mean();
}

gpu::FloatImage sharp(HeadlessRenderer& headless, QualityScene& scene, RenderView view) {
    view.lens.aperture_radius = 0;
    return scene.render(headless, view);
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

/// Diameter of the uniform disc that, convolved with `from`, has the variance of `to` [px].
double disc_diameter(const Moments& from, const Moments& to) {
    return 4 * std::sqrt(std::max(to.variance - from.variance, 0.0));
}

/// A lamp of 2 x 2 px, on a dark wall or in front of a black background.
void add_lamp(QualityScene& scene, float distance, bool wall) {
    const MeshId square = scene.add(quality_square());
    const float pixel = pixel_at(distance);
    scene.place(
        square, shining(scene, Vec3(500)), placed_at({3 * pixel, -4 * pixel, -distance}, pixel));
    if (wall) {
        const float behind = 1.0001f * distance;
        scene.place(square, shining(scene, Vec3(0)), placed_at({0, 0, -behind}, 300 * pixel));
    }
}

/// Largest differences of discs from the thin-lens law.
struct DiscErrors {
    double diameter = 0;  ///< [px]
    double light = 0;
    double samples = 0;  ///< error of the ground truth's diameter [px]
};

DiscErrors measure_discs(HeadlessRenderer& headless, bool wall, QualityReport& report) {
    const oracle::ThinLens lens = oracle::lens_of_camera(
        static_cast<double>(kFovY), static_cast<double>(kFilm), double(kFNumber), double(kFocus));
    const RenderView view = fast_view();
    DiscErrors errors;
    for (const double distance : {0.7, 0.85, 1.0, 1.15, 1.3, 1.5, 2.6, 3.0, 4.0, 6.0, 10.0, 30.0}) {
        QualityScene scene;
        add_lamp(scene, static_cast<float>(distance), wall);
        const Moments point = moments_of(sharp(headless, scene, view));
        const gpu::FloatImage effect = scene.render(headless, view);
        const Moments disc = moments_of(effect);
        const double wanted =
            oracle::image_diameter(lens, distance) / static_cast<double>(kFilm) * kHeight;
        const double found = disc_diameter(point, disc);
        errors.diameter = std::max(errors.diameter, std::abs(found - wanted));
        errors.light = std::max(errors.light, std::abs(disc.light / point.light - 1));
        if (wall) {
            report.inform(
                fmt::format(
                    "disc at {} m, diameter ({:.2f} px by the thin-lens law)", distance, wanted),
                found, "px");
        }
        if (wall && (distance == 0.7 || distance == 30.0)) {
            const gpu::FloatImage truth = sampled(headless, scene, view);
            const double diameter = disc_diameter(point, moments_of(truth));
            errors.samples = std::max(errors.samples, std::abs(diameter - wanted));
            report.images.push_back(
                {fmt::format("a lamp at {} m", distance), displayed(effect), displayed(truth)});
        }
    }
    return errors;
}

void measure_law(HeadlessRenderer& headless, QualityReport& report) {
    const DiscErrors wall = measure_discs(headless, true, report);
    const DiscErrors night = measure_discs(headless, false, report);
    report.at_most("largest difference from the diameter law", wall.diameter, 0.5, "px");
    report.inform("the same for the 256-sample ground truth", wall.samples, "px");
    report.at_most("energy error of a disc", 100 * wall.light, 1, "%");
    report.at_most(
        "difference from the law, lamps on a black background", night.diameter, 0.5, "px");
    report.at_most("energy error of those", 100 * night.light, 2, "%");
}

// ---- edges

/// A bright card of 54 x 54 px in front of a dark wall.
void add_card(QualityScene& scene, float distance, float wall) {
    const MeshId square = scene.add(quality_square());
    scene.place(
        square, shining(scene, Vec3(1)), placed_at({0, 0, -distance}, 27 * pixel_at(distance)));
    scene.place(square, shining(scene, Vec3(0)), placed_at({0, 0, -wall}, 2 * wall));
}

/// Light of a card in focus that leaks into pixels outside it.
void measure_leak(HeadlessRenderer& headless, QualityReport& report) {
    QualityScene scene;
    add_card(scene, kFocus, 40);
    const RenderView view = fast_view();
    const gpu::FloatImage without = sharp(headless, scene, view);
    const gpu::FloatImage with = scene.render(headless, view);
    double leak = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            if (without.at(x, y, 0) == 0) {
                leak = std::max(leak, static_cast<double>(with.at(x, y, 0)));
            }
        }
    }
    report.at_most("leak of an object in focus", 255 * leak, 2, "/ 255");
}

/// Light of a near card outside its sharp silhouette.
void measure_spread(HeadlessRenderer& headless, QualityReport& report) {
    QualityScene scene;
    add_card(scene, 1.2f, kFocus);
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
    const gpu::FloatImage effect = scene.render(headless, view);
    report.at_most(
        "light outside the silhouette of a near card, vs ground truth",
        100 * std::abs(outside(effect) / outside(truth) - 1), 5, "%");
    report.images.push_back({"a near card", displayed(effect), displayed(truth)});
}

// ---- scenes

/// Lamps at night behind a ball, with a post in front of it.
void populate_night(QualityScene& scene) {
    scene.add_light(
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
        const auto fraction = [i](float step) {
            const float x = step * static_cast<float>(i + 1);
            return x - std::floor(x);
        };
        const float z = -5 - 7 * fraction(0.7549f);
        const Vec3 position = {
            -z * 0.9f * (fraction(0.5698f) - 0.5f), -z * 0.3f * fraction(0.3819f), z};
        const Vec3 light = i % 3 == 0   ? Vec3(90, 45, 12)
                           : i % 3 == 1 ? Vec3(15, 40, 90)
                                        : Vec3(80, 20, 50);
        scene.place(ball, shining(scene, light), placed_at(position, 0.03f));
    }
}

void measure_scene(
    HeadlessRenderer& headless, QualityScene& scene, const RenderView& view, const char* name,
    QualityReport& report) {
    const ColorImage truth = displayed(sampled(headless, scene, view));
    ColorImage effect = displayed(scene.render(headless, view));
    RenderView by_levels = view;
    by_levels.lens.method = FocusMethod::Mip;
    const auto row = [&](const char* what, const ColorImage& image) {
        report.inform(fmt::format("{}, {}", name, what), psnr(image, truth), "dB");
    };
    row("PSNR", effect);
    row("PSNR by mip levels", displayed(scene.render(headless, by_levels)));
    row("PSNR of the sharp image", displayed(sharp(headless, scene, view)));
    report.images.push_back({name, std::move(effect), truth});
}

Status measure_dof(HeadlessRenderer& headless, QualityReport& report) {
    measure_law(headless, report);
    measure_leak(headless, report);
    measure_spread(headless, report);
    {
        QualityScene night;
        populate_night(night);
        measure_scene(headless, night, fast_view(), "lamps behind a ball", report);
    }
    QualityScene court;
    add_daylight(court);
    populate_court(court);
    const Lens lens = {.f_number = 0.35f, .focus_distance = 6.5f, .sensor_height = kFilm};
    const RenderView view = lens_view(kCourtEye, kCourtTarget, lens);
    measure_scene(headless, court, view, "court", report);
    return Done{};
}

const RegisterQuality kRegistered("dof", "the mean of 256 views across the lens", measure_dof);

}  // namespace
}  // namespace limn::dof_quality
