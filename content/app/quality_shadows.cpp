#include "content/app/quality_shadows.h"

#include "bench/oracles/shadow_oracle.h"
#include "content/app/quality_court.h"
#include "content/app/quality_scene.h"
#include "content/make/shapes.h"
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

namespace limn {
namespace {

using oracle::DVec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

constexpr Vec3 kLamp = {2.3f, 4.2f, 2.4f};
constexpr float kLampSize = 0.3f;  ///< [m]
const Vec3 kToSun = glm::normalize(Vec3(0.8f, 0.75f, 0.35f));
constexpr float kSunSize = 0.05f;  ///< [rad]: five times the real one, so that it is seen

/// How light, shadow by shadow, falls into the scene.
enum class Kind : std::uint8_t { Spot, Point, Sun };
constexpr Kind kKinds[] = {Kind::Spot, Kind::Point, Kind::Sun};

const char* name_of(Kind kind) {
    return kind == Kind::Spot ? "spot" : kind == Kind::Point ? "point light" : "sun";
}

struct Method {
    const char* name;
    Shadow shadow;
    ShadowVolume volume;
    double agree;  ///< least share of the pixels [%] (design 7)
};

/// For contact hardening the light is as large as it is said to be, for all others a point.
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
    if (kind != Kind::Point) {  // which has six views, none of them the camera's
        all.push_back({"map, perspective", perspective, {}, kMaps});
    }
    return all;
}

/// `candela` of lamps; a sun is a sun.
Entity
light_up(QualityScene& scene, Kind kind, const Vec3& from, const Vec3& target, float candela) {
    switch (kind) {
    case Kind::Spot:
        return scene.shine(
            SpotLight{
                .color = {1, 0.86f, 0.66f},
                .intensity = candela,
                .radius = 14,
                .inner_angle = radians(24.0f),
                .outer_angle = radians(34.0f)},
            look_at(from, target));
    case Kind::Point:
        return scene.shine(
            PointLight{.color = {1, 0.86f, 0.66f}, .intensity = candela, .radius = 14},
            placed_at(from));
    case Kind::Sun:
        return scene.shine(
            DirectionalLight{.color = {1, 0.93f, 0.82f}}, look_at({0, 0, 0}, target - from));
    }
    return {};
}

// ---- the scene

/// What each pixel shows, row by row from the top.
struct Seen {
    std::vector<DVec3> point;
    std::vector<DVec3> normal;
};

Seen look(QualityScene& scene, HeadlessRenderer& headless, const RenderView& view) {
    const FrameOutput frame =
        render_frame(*headless.renderer, scene.world, view, {.aovs = {"depth", "normal"}});
    const gpu::FloatImage depth = gpu::read_floats(*frame.aovs[0].texture);
    const gpu::FloatImage normal = gpu::read_floats(*frame.aovs[1].texture);
    const auto& r = view.world_from_camera.row;
    const auto column = [&](int c) { return DVec3(r[0][c], r[1][c], r[2][c]); };
    Seen seen;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double px = (2 * (x + 0.5) / kWidth - 1) * view.tangent.x;
            const double py = (1 - 2 * (y + 0.5) / kHeight) * view.tangent.y;
            const double d = depth.at(x, y, 0);
            seen.point.push_back(column(3) + d * (px * column(0) + py * column(1) - column(2)));
            seen.normal.emplace_back(normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2));
        }
    }
    return seen;
}

// ---- pictures and rays

/// A scene's pictures without the light, and with it but without its shadows.
struct Unshadowed {
    gpu::FloatImage dark;
    gpu::FloatImage open;
};

/// How much a pixel is brighter for the light, without shadows.
double gain(const Unshadowed& pictures, std::size_t pixel) {
    return pictures.open.pixels[4 * pixel + 1] - pictures.dark.pixels[4 * pixel + 1];
}

constexpr double kLeastGain = 1e-4;  ///< radiance: less, and the light does not reach the pixel

/// Share of the light that reaches each pixel; 1 where it makes no difference.
std::vector<double> shares_of(const Unshadowed& pictures, const gpu::FloatImage& shaded) {
    std::vector<double> shares(kPixels, 1);
    for (std::size_t i = 0; i < kPixels; ++i) {
        if (gain(pictures, i) > kLeastGain) {
            shares[i] =
                (shaded.pixels[4 * i + 1] - pictures.dark.pixels[4 * i + 1]) / gain(pictures, i);
        }
    }
    return shares;
}

/// Where it comes from: its middle, or the direction of one without a place; its diameter.
struct Source {
    Kind kind;
    DVec3 place;
    double size = 0;
};

/// The same, by rays.
std::vector<double> cast_rays(
    const oracle::ShadowScene& rays, const Source& source, const Seen& seen,
    const Unshadowed& pictures) {
    constexpr double kFar = 1000;  // a sun's disc, for rays with an end [m]
    std::vector<double> shares(kPixels, 1);
    parallel_for(kPixels, kWidth, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (gain(pictures, i) <= kLeastGain) {
                continue;
            }
            const DVec3 point = seen.point[i] + 1e-4 * seen.normal[i];
            const bool sun = source.kind == Kind::Sun;
            const DVec3 middle = sun ? point + kFar * source.place : source.place;
            const double diameter = source.size * (sun ? kFar : 1);
            if (diameter == 0) {
                shares[i] = rays.blocked(point, middle) ? 0 : 1;
                continue;
            }
            shares[i] = rays.seen_share(point, middle, diameter, 5);
            if (shares[i] > 0 && shares[i] < 1) {
                shares[i] = rays.seen_share(point, middle, diameter, 12);
            }
        }
    });
    return shares;
}

ColorImage picture_of(const Unshadowed& pictures, const std::vector<double>& shares) {
    gpu::FloatImage image = pictures.dark;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto share = static_cast<float>(shares[i / 4]);
        image.pixels[i] += share * (pictures.open.pixels[i] - pictures.dark.pixels[i]);
    }
    return displayed(image);
}

/// Share of the pixels that the light can reach on which both say whether it does [%].
double agreement(
    const Unshadowed& pictures, const std::vector<double>& found,
    const std::vector<double>& expected) {
    int counted = 0;
    int same = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        if (gain(pictures, i) > kLeastGain) {
            ++counted;
            same += (found[i] < 0.5) == (expected[i] < 0.5) ? 1 : 0;
        }
    }
    return 100.0 * same / std::max(counted, 1);
}

/// Nine details of pictures, twice as large, in three rows.
class Details {
  public:
    Details() { sheet_.pixels.resize(static_cast<std::size_t>(sheet_.width) * sheet_.height); }
    /// The corner where the block stands in its own shadow.
    void add(const ColorImage& picture) {
        constexpr IVec2 kCorner = {72, 96};
        const int left = count_ % 3 * (2 * kCropWidth + 1);
        const int top = count_ / 3 * (2 * kCropHeight + 1);
        for (int y = 0; y < 2 * kCropHeight; ++y) {
            for (int x = 0; x < 2 * kCropWidth; ++x) {
                sheet_.pixels[static_cast<std::size_t>((top + y) * sheet_.width + left + x)] =
                    picture.pixels[static_cast<std::size_t>(
                        (kCorner.y + y / 2) * picture.width + kCorner.x + x / 2)];
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
    furnish_court(scene);
    scene.world.insert_resource(
        Environment{.sky = SkyKind::Uniform, .zenith = {0.045f, 0.055f, 0.085f}});
    const RenderView view = court_view(kWidth, kHeight);
    const Seen seen = look(scene, headless, view);
    const oracle::ShadowScene rays(scene.world);
    const gpu::FloatImage dark = scene.radiance(headless, view);
    for (const Kind kind : kKinds) {
        const bool sun = kind == Kind::Sun;
        const Entity light = sun ? light_up(scene, kind, kToSun, {0, 0, 0}, 0)
                                 : light_up(scene, kind, kLamp, {-0.4f, 0.4f, -0.3f}, 75);
        const Unshadowed pictures = {dark, scene.radiance(headless, view)};
        Source source = {kind, DVec3(sun ? kToSun : kLamp)};
        const std::vector<double> of_point = cast_rays(rays, source, seen, pictures);
        source.size = sun ? kSunSize : kLampSize;
        const std::vector<double> of_disc = cast_rays(rays, source, seen, pictures);
        Details found_details;
        Details expected_details;
        std::string names;
        for (const Method& method : methods(kind)) {
            scene.world.add(light, method.shadow);
            scene.world.add(light, method.volume);
            const gpu::FloatImage shaded = scene.radiance(headless, view);
            const std::vector<double>& expected = has_size(method) ? of_disc : of_point;
            const double agree = agreement(pictures, shares_of(pictures, shaded), expected);
            const std::string title = fmt::format("{}: {}", name_of(kind), method.name);
            report.rows.push_back(
                {title + ", pixels that agree with rays", agree, QualityBound::AtLeast,
                 method.agree, "%"});
            report.pictures.push_back({title, displayed(shaded), picture_of(pictures, expected)});
            found_details.add(report.pictures.back().effect);
            expected_details.add(report.pictures.back().oracle);
            names += fmt::format("{}{}", names.empty() ? "" : "; ", method.name);
        }
        report.pictures.push_back(
            {fmt::format("{}, a corner by each method: {}", name_of(kind), names),
             found_details.sheet(), expected_details.sheet()});
        scene.world.destroy(light);
    }
}

// ---- penumbras

/// What a share that goes from 0 to 1 along x is spread over, if it does as the light of a disc
/// does behind an edge: four standard deviations of where it rises. `profile`: x and share.
double rise_width(std::vector<std::pair<double, double>> profile) {
    constexpr double kStep = 0.01;
    std::sort(profile.begin(), profile.end());
    std::vector<double> sums(100, 0.0);
    std::vector<int> counts(100, 0);
    for (const auto& [x, share] : profile) {
        const auto bin = static_cast<std::size_t>(std::clamp((x + 0.5) / kStep, 0.0, 99.0));
        sums[bin] += share;
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

/// A board whose edge is at x = 0, a meter above a floor, beneath the light.
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
    const Seen seen = look(scene, headless, view);
    const oracle::ShadowScene rays(scene.world);
    for (const Kind kind : kKinds) {
        const bool sun = kind == Kind::Sun;
        const double size = sun ? 0.15 : 0.3;
        const Entity light = light_up(scene, kind, {0, kLight, 0}, {0, 0, 0}, 18);
        const Unshadowed pictures = {
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
        const std::vector<double> shares = shares_of(pictures, shaded);
        std::vector<std::pair<double, double>> profile;
        for (std::size_t i = 0; i < kPixels; ++i) {
            if (gain(pictures, i) > kLeastGain && seen.point[i].y < 0.01
                && std::abs(seen.point[i].x) < 0.45) {
                profile.emplace_back(seen.point[i].x, shares[i]);
            }
        }
        const double law = sun ? 2 * std::tan(0.5 * size) * kBoard
                               : oracle::penumbra_width(size, kLight - kBoard, kLight);
        const std::string title =
            fmt::format("{}: penumbra of an edge {:g} m above", name_of(kind), kBoard);
        report.rows.push_back(
            {title + ", width off the law by",
             100 * std::abs(rise_width(std::move(profile)) / law - 1), QualityBound::AtMost, 15,
             "%"});
        const Source source = {kind, sun ? DVec3(0, 1, 0) : DVec3(0, kLight, 0), size};
        report.pictures.push_back(
            {title, displayed(shaded),
             picture_of(pictures, cast_rays(rays, source, seen, pictures))});
        scene.world.destroy(light);
    }
}

}  // namespace

Result<QualityReport> measure_shadows(HeadlessRenderer& headless) {
    QualityReport report;
    measure_methods(headless, report);
    measure_penumbras(headless, report);
    return report;
}

}  // namespace limn
