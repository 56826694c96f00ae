#include "bench/oracles/shadow_oracle.h"
#include "bench/quality/quality_scene.h"
#include "content/make/models/shapes.h"
#include "ecs/base/jobs.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "render/render_frame.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::shadows_quality {
namespace {

using oracle::DVec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

constexpr Vec3 kLamp = {2.3f, 4.2f, 2.4f};
constexpr float kLampSize = 0.3f;  ///< [m]
const Vec3 kToSun = glm::normalize(Vec3(0.8f, 0.75f, 0.35f));
constexpr float kSunSize = 0.05f;  ///< [rad] five times the real one, for a visible penumbra

/// Type of the scene's light.
enum class Kind : std::uint8_t { Spot, Point, Sun };
constexpr Kind kKinds[] = {Kind::Spot, Kind::Point, Kind::Sun};

const char* name_of(Kind kind) {
    return kind == Kind::Spot ? "spot" : kind == Kind::Point ? "point light" : "sun";
}

struct Method {
    const char* name;
    Shadow shadow;
    ShadowVolume volume;
    double agree;  ///< smallest percentage of pixels that must agree with rays (design 7)
};

/// Contact hardening is compared with an area light, all others with a point light.
bool has_size(const Method& method) {
    return method.shadow.filter == ShadowFilter::ContactHardening;
}

std::vector<Method> methods(Kind kind) {
    const auto map = [kind](ShadowFilter filter) {
        return Shadow{
            .method = ShadowMethod::Map,
            .filter = filter,
            .resolution = 512,
            .source_size = kind == Kind::Sun ? kSunSize : kLampSize,
            .distance = 16};
    };
    const Shadow volume = {.method = ShadowMethod::Volume};
    Shadow hybrid = map(ShadowFilter::Bilinear);
    hybrid.method = ShadowMethod::Hybrid;
    Shadow perspective = map(ShadowFilter::Bilinear);
    perspective.method = ShadowMethod::Perspective;
    constexpr double kMaps = 98;
    constexpr double kVolumes = 99.9;
    std::vector<Method> all = {
        {"map, hard", map(ShadowFilter::Hard), {}, kMaps},
        {"map, 2x2", map(ShadowFilter::Bilinear), {}, kMaps},
        {"map, soft", map(ShadowFilter::Soft), {}, kMaps},
        {"map, contact hardening", map(ShadowFilter::ContactHardening), {}, kMaps},
        {"volumes, z-pass", volume, {.mode = StencilMode::ZPass}, kVolumes},
        {"volumes, z-fail", volume, {.mode = StencilMode::ZFail}, kVolumes},
        {"volumes per triangle", volume, {.kind = VolumeKind::PerTriangle}, kVolumes},
        {"hybrid", hybrid, {}, kVolumes},
    };
    if (kind != Kind::Point) {  // a cube map has no perspective shadow map
        all.push_back({"map, perspective", perspective, {}, kMaps});
    }
    return all;
}

/// Adds a light; `candela` is ignored for a sun.
Entity
light_up(QualityScene& scene, Kind kind, const Vec3& from, const Vec3& target, float candela) {
    switch (kind) {
    case Kind::Spot:
        return scene.add_light(
            SpotLight{
                .color = {1, 0.86f, 0.66f},
                .intensity = candela,
                .radius = 14,
                .inner_angle = radians(24.0f),
                .outer_angle = radians(34.0f)},
            look_at(from, target));
    case Kind::Point:
        return scene.add_light(
            PointLight{.color = {1, 0.86f, 0.66f}, .intensity = candela, .radius = 14},
            placed_at(from));
    case Kind::Sun:
        return scene.add_light(
            DirectionalLight{.color = {1, 0.93f, 0.82f}}, look_at({0, 0, 0}, target - from));
    }
    return {};
}

// ---- the scene

/// Surface point and normal of each pixel, row by row from the top.
struct SurfacePoints {
    std::vector<DVec3> point;
    std::vector<DVec3> normal;
};

SurfacePoints
render_surface(QualityScene& scene, HeadlessRenderer& headless, const RenderView& view) {
    const FrameOutput frame =
        render_frame(*headless.renderer, scene.world, view, {.aovs = {"depth", "normal"}});
    const gpu::FloatImage depth = gpu::read_floats(*frame.aovs[0].texture);
    const gpu::FloatImage normal = gpu::read_floats(*frame.aovs[1].texture);
    SurfacePoints surface;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double distance = depth.at(x, y, 0);
            surface.point.push_back(eye_of(view) + distance * pixel_ray(view, x, y));
            surface.normal.emplace_back(normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2));
        }
    }
    return surface;
}

// ---- images and rays

/// A scene's radiance without the light, and with the light but without its shadows.
struct Unshadowed {
    gpu::FloatImage dark;
    gpu::FloatImage open;
};

/// Radiance that the unshadowed light adds to a pixel.
double gain(const Unshadowed& images, std::size_t pixel) {
    return images.open.pixels[4 * pixel + 1] - images.dark.pixels[4 * pixel + 1];
}

constexpr double kMinGain = 1e-4;  ///< radiance below which a pixel counts as unlit

/// Visibility of the light at each pixel, 0 .. 1; 1 where the light adds nothing.
std::vector<double> visibility_of(const Unshadowed& images, const gpu::FloatImage& shaded) {
    std::vector<double> visibility(kPixels, 1);
    for (std::size_t i = 0; i < kPixels; ++i) {
        if (gain(images, i) > kMinGain) {
            visibility[i] =
                (shaded.pixels[4 * i + 1] - images.dark.pixels[4 * i + 1]) / gain(images, i);
        }
    }
    return visibility;
}

/// The light source: its center, or the direction toward a sun; its diameter [m], or angle of a sun
/// [rad].
struct Source {
    Kind kind;
    DVec3 center;
    double size = 0;
};

/// The same visibility by ray casting.
std::vector<double> cast_rays(
    const oracle::ShadowScene& rays, const Source& source, const SurfacePoints& surface,
    const Unshadowed& images) {
    constexpr double kFar = 1000;  // distance of a sun's disc, for finite rays [m]
    std::vector<double> visibility(kPixels, 1);
    parallel_for(kPixels, kWidth, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (gain(images, i) <= kMinGain) {
                continue;
            }
            const DVec3 point = surface.point[i] + 1e-4 * surface.normal[i];
            const bool sun = source.kind == Kind::Sun;
            const DVec3 center = sun ? point + kFar * source.center : source.center;
            const double diameter = source.size * (sun ? kFar : 1);
            if (diameter == 0) {
                visibility[i] = rays.blocked(point, center) ? 0 : 1;
                continue;
            }
            visibility[i] = rays.visible_fraction(point, center, diameter, 5);
            if (visibility[i] > 0 && visibility[i] < 1) {
                visibility[i] = rays.visible_fraction(point, center, diameter, 12);
            }
        }
    });
    return visibility;
}

ColorImage image_of(const Unshadowed& images, const std::vector<double>& visibility) {
    gpu::FloatImage image = images.dark;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto fraction = static_cast<float>(visibility[i / 4]);
        image.pixels[i] += fraction * (images.open.pixels[i] - images.dark.pixels[i]);
    }
    return displayed(image);
}

/// Percentage of the pixels reached by the unshadowed light on which both agree whether it is
/// shadowed.
double agreement(
    const Unshadowed& images, const std::vector<double>& found,
    const std::vector<double>& expected) {
    int counted = 0;
    int same = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        if (gain(images, i) > kMinGain) {
            ++counted;
            same += (found[i] < 0.5) == (expected[i] < 0.5) ? 1 : 0;
        }
    }
    return 100.0 * same / std::max(counted, 1);
}

/// A 3 x 3 sheet of image crops, magnified twice.
class Details {
  public:
    Details() { sheet_.pixels.resize(static_cast<std::size_t>(sheet_.width) * sheet_.height); }
    /// Adds the crop around the block and its shadow.
    void add(const ColorImage& image) {
        constexpr IVec2 kCorner = {72, 96};
        const int left = count_ % 3 * (2 * kCropWidth + 1);
        const int top = count_ / 3 * (2 * kCropHeight + 1);
        for (int y = 0; y < 2 * kCropHeight; ++y) {
            for (int x = 0; x < 2 * kCropWidth; ++x) {
                sheet_.pixels[static_cast<std::size_t>((top + y) * sheet_.width + left + x)] =
                    image.pixels[static_cast<std::size_t>(
                        (kCorner.y + y / 2) * image.width + kCorner.x + x / 2)];
            }
        }
        ++count_;
    }
    [[nodiscard]] const ColorImage& sheet() const { return sheet_; }

  private:
    static constexpr int kCropWidth = 53;
    static constexpr int kCropHeight = 30;
    ColorImage sheet_ = {6 * kCropWidth + 2, 6 * kCropHeight + 2, {}};
    int count_ = 0;
};

void measure_methods(HeadlessRenderer& headless, QualityReport& report) {
    QualityScene scene;
    populate_court(scene);
    scene.world.insert_resource(
        Environment{.sky = SkyKind::Uniform, .zenith = {0.045f, 0.055f, 0.085f}});
    const RenderView view = court_view(kWidth, kHeight);
    const SurfacePoints surface = render_surface(scene, headless, view);
    const oracle::ShadowScene rays(scene.world);
    const gpu::FloatImage dark = scene.radiance(headless, view);
    for (const Kind kind : kKinds) {
        const bool sun = kind == Kind::Sun;
        const Entity light = sun ? light_up(scene, kind, kToSun, {0, 0, 0}, 0)
                                 : light_up(scene, kind, kLamp, {-0.4f, 0.4f, -0.3f}, 75);
        const Unshadowed images = {dark, scene.radiance(headless, view)};
        Source source = {kind, DVec3(sun ? kToSun : kLamp)};
        const std::vector<double> of_point = cast_rays(rays, source, surface, images);
        source.size = sun ? kSunSize : kLampSize;
        const std::vector<double> of_disc = cast_rays(rays, source, surface, images);
        Details found_details;
        Details expected_details;
        std::string names;
        for (const Method& method : methods(kind)) {
            scene.world.add(light, method.shadow);
            scene.world.add(light, method.volume);
            const gpu::FloatImage shaded = scene.radiance(headless, view);
            const std::vector<double>& expected = has_size(method) ? of_disc : of_point;
            const double agree = agreement(images, visibility_of(images, shaded), expected);
            const std::string title = fmt::format("{}: {}", name_of(kind), method.name);
            report.at_least(
                title + ", pixels that agree with ray casting", agree, method.agree, "%");
            report.images.push_back({title, displayed(shaded), image_of(images, expected)});
            found_details.add(report.images.back().effect);
            expected_details.add(report.images.back().oracle);
            names += fmt::format("{}{}", names.empty() ? "" : "; ", method.name);
        }
        report.images.push_back(
            {fmt::format("{}, a crop for each method: {}", name_of(kind), names),
             found_details.sheet(), expected_details.sheet()});
        scene.world.destroy(light);
    }
}

// ---- penumbras

/// Width of a penumbra whose visibility rises from 0 to 1 along x like that of a disc light behind
/// an edge: four standard deviations of the slope. `profile`: pairs of x and visibility.
double rise_width(std::vector<std::pair<double, double>> profile) {
    constexpr double kStep = 0.01;
    std::sort(profile.begin(), profile.end());
    std::vector<double> sums(100, 0.0);
    std::vector<int> counts(100, 0);
    for (const auto& [x, visibility] : profile) {
        const auto bin = static_cast<std::size_t>(std::clamp((x + 0.5) / kStep, 0.0, 99.0));
        sums[bin] += visibility;
        ++counts[bin];
    }
    double total = 0;
    double first = 0;
    double second = 0;
    for (std::size_t i = 1; i < sums.size(); ++i) {
        if (counts[i - 1] == 0 || counts[i] == 0) {
            continue;
        }
        const double rise = sums[i] / counts[i] - sums[i - 1] / counts[i - 1];
        const double x = kStep * static_cast<double>(i) - 0.5;
        total += rise;
        first += rise * x;
        second += rise * x * x;
    }
    const double mean = first / total;
    return 4 * std::sqrt(std::max(second / total - mean * mean, 0.0));
}

/// Penumbras of a board below the light, a meter above the floor, with its edge at x = 0.
void measure_penumbras(HeadlessRenderer& headless, QualityReport& report) {
    constexpr float kBoard = 1;
    constexpr float kLight = 3;
    QualityScene scene;
    const MaterialId stone =
        scene.add(Material{.base_color = {0.6f, 0.57f, 0.5f, 1}, .roughness = 0.9f});
    scene.place(scene.add(make_box({.size = {6, 0.1f, 6}})), stone, placed_at({0, -0.05f, 0}));
    scene.place(scene.add(make_box({.size = {2, 0.002f, 4}})), stone, placed_at({-1, kBoard, 0}));
    const RenderView view =
        quality_view({0, 0.5f, 1.1f}, {0, 0, 0}, kWidth, kHeight, radians(45.0f));
    const SurfacePoints surface = render_surface(scene, headless, view);
    const oracle::ShadowScene rays(scene.world);
    for (const Kind kind : kKinds) {
        const bool sun = kind == Kind::Sun;
        const double size = sun ? 0.15 : 0.3;
        const Entity light = light_up(scene, kind, {0, kLight, 0}, {0, 0, 0}, 18);
        const Unshadowed images = {
            {kWidth, kHeight, 4, std::vector<float>(4 * kPixels, 0.0f)},
            scene.radiance(headless, view)};
        scene.world.add(
            light, Shadow{
                       .method = ShadowMethod::Map,
                       .filter = ShadowFilter::ContactHardening,
                       .resolution = 1024,
                       .source_size = static_cast<float>(size),
                       .cascades = 1,
                       .distance = 6});
        const gpu::FloatImage shaded = scene.radiance(headless, view);
        const std::vector<double> visibility = visibility_of(images, shaded);
        std::vector<std::pair<double, double>> profile;
        for (std::size_t i = 0; i < kPixels; ++i) {
            if (gain(images, i) > kMinGain && surface.point[i].y < 0.01
                && std::abs(surface.point[i].x) < 0.45) {
                profile.emplace_back(surface.point[i].x, visibility[i]);
            }
        }
        const double law = sun ? 2 * std::tan(0.5 * size) * kBoard
                               : oracle::penumbra_width(size, kLight - kBoard, kLight);
        const std::string title =
            fmt::format("{}: penumbra of an edge {:g} m above", name_of(kind), kBoard);
        report.at_most(
            title + ", width error against theory",
            100 * std::abs(rise_width(std::move(profile)) / law - 1), 15, "%");
        const Source source = {kind, sun ? DVec3(0, 1, 0) : DVec3(0, kLight, 0), size};
        report.images.push_back(
            {title, displayed(shaded), image_of(images, cast_rays(rays, source, surface, images))});
        scene.world.destroy(light);
    }
}

Status measure_shadows(HeadlessRenderer& headless, QualityReport& report) {
    measure_methods(headless, report);
    measure_penumbras(headless, report);
    return Done{};
}

const RegisterQuality kRegistered(
    "shadows", "rays from each pixel's surface point to the light, in double precision",
    measure_shadows);

}  // namespace
}  // namespace limn::shadows_quality
