#include "content/app/quality_lights.h"

#include "bench/oracles/cluster_oracle.h"
#include "bench/oracles/cluster_readback.h"
#include "bench/oracles/light_oracle.h"
#include "content/app/quality_scene.h"
#include "ecs/base/hash.h"
#include "ecs/base/rng.h"
#include "ecs/components/light.h"
#include "ecs/components/rendering.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

using oracle::DVec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kLamps = 300;
constexpr double kAlbedo = 0.8;
constexpr float kHalfFloor = 40;  ///< of the floor's side [m]
constexpr int kLightsAtOnce = 60;
constexpr int kRandomTests = 100000;
constexpr int kReachingTests = 10000;  ///< of them, at least so many of a light that reaches

/// Numbers for a scene that is the same every time.
class Numbers {
  public:
    explicit Numbers(std::uint64_t seed) : random_(seed, 0, name_hash("quality_lights"), 0) {}
    float signed_unit() { return random_.uniform(-1.0f, 1.0f); }
    Vec3 in_cube(float half) {
        const float x = signed_unit();
        const float y = signed_unit();
        return half * Vec3(x, y, signed_unit());
    }

  private:
    Random random_;
};

struct Lamp {
    PointLight point;
    SpotLight spot;
    Affine pose;
    bool is_spot = false;
};

Vec3 place_of(const Affine& pose) {
    return {pose.row[0].w, pose.row[1].w, pose.row[2].w};
}

/// Over the floor, of all colors; every third a spot that looks down aslant.
std::vector<Lamp> make_lamps() {
    Numbers numbers(21);
    std::vector<Lamp> lamps;
    for (int i = 0; i < kLamps; ++i) {
        const Vec3 tint = Vec3(0.55f) + numbers.in_cube(0.45f);
        Vec3 position = numbers.in_cube(12);
        position.z = 0.8f + 0.5f * numbers.signed_unit();
        const float radius = 2.5f + numbers.signed_unit();
        const Vec3 target = {position.x + numbers.signed_unit(), position.y + 0.5f, 0};
        lamps.push_back(
            {.point = {.color = tint, .intensity = 0.9f, .radius = radius},
             .spot = {.color = tint, .intensity = 2.5f, .radius = radius + 2},
             .pose = look_at(position, target),
             .is_spot = i % 3 == 2});
    }
    return lamps;
}

/// What the floor sends on of all lamps.
DVec3 reflected(const std::vector<Lamp>& lamps, const DVec3& point) {
    const DVec3 normal = {0, 0, 1};
    DVec3 sum(0);
    for (const Lamp& lamp : lamps) {
        const auto& row = lamp.pose.row;
        const DVec3 axis = {-row[0].z, -row[1].z, -row[2].z};
        const DVec3 position(place_of(lamp.pose));
        const oracle::Arriving light =
            lamp.is_spot ? oracle::arrive(lamp.spot, position, axis, point, normal)
                         : oracle::arrive(lamp.point, position, point, normal);
        sum += kAlbedo * light.color * std::max(light.to_light.z, 0.0);
    }
    return sum;
}

/// The floor z = 0 as every pixel sees it; black where it ends.
gpu::FloatImage oracle_picture(const std::vector<Lamp>& lamps, const RenderView& view) {
    gpu::FloatImage image{.width = kWidth, .height = kHeight, .channels = 3, .pixels = {}};
    const auto& row = view.world_from_camera.row;
    const auto column = [&](int c) { return DVec3(row[0][c], row[1][c], row[2][c]); };
    const DVec3 eye = column(3);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double right = ((x + 0.5) / kWidth * 2 - 1) * static_cast<double>(view.tangent.x);
            const double up = (1 - (y + 0.5) / kHeight * 2) * static_cast<double>(view.tangent.y);
            const DVec3 ray = right * column(0) + up * column(1) - column(2);
            const DVec3 point = eye - ray * (eye.z / ray.z);
            const bool there =
                ray.z < 0 && std::abs(point.x) < kHalfFloor && std::abs(point.y) < kHalfFloor;
            const DVec3 color = there ? reflected(lamps, point) : DVec3(0);
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<float>(color[c]));
            }
        }
    }
    return image;
}

void measure_pictures(HeadlessRenderer& headless, QualityReport& report) {
    constexpr const char* kMethods[kLightMethods] = {
        "clustered", "a full-screen pass a light", "light volumes", "objects with their lights",
        "lights with their objects"};
    const std::vector<Lamp> lamps = make_lamps();
    QualityScene scene;
    const auto gray = static_cast<float>(kAlbedo);
    const MaterialId matte = scene.add(Material{
        .shading = ShadingModel::Blinn,
        .base_color = {gray, gray, gray, 1},
        .specular = {0, 0, 0}});
    scene.place(scene.add(quality_square()), matte, placed_at({0, 0, 0}, kHalfFloor));
    for (const Lamp& lamp : lamps) {
        lamp.is_spot ? scene.shine(lamp.spot, lamp.pose) : scene.shine(lamp.point, lamp.pose);
    }
    // Slanting, so that the floor crosses many slices.
    const RenderView view = quality_view({0, -13, 4}, {0, -2, 0}, kWidth, kHeight, radians(60.0f));
    const ColorImage expected = displayed(oracle_picture(lamps, view));
    for (int method = 0; method < kLightMethods; ++method) {
        scene.world.insert_resource(Rendering{static_cast<LightMethod>(method)});
        const ColorImage found = displayed(scene.radiance(headless, view));
        report.rows.push_back(
            {fmt::format("{} lights, {}: largest difference on screen", kLamps, kMethods[method]),
             255.0 * static_cast<double>(largest_difference(found, expected).difference),
             QualityBound::AtMost, 1, "/ 255"});
        if (method == 0) {
            report.pictures.push_back(
                {fmt::format("{} lights by clusters", kLamps), found, expected});
        }
    }
}

/// A light of any reach; every third a spot.
LightReach random_reach(Numbers& numbers, int i) {
    LightReach light = {numbers.in_cube(25), std::exp2(3 * numbers.signed_unit())};
    if (i % 3 == 0) {
        light.axis = normalize_or(numbers.in_cube(1), {0, 1, 0});
        light.cosine = std::cos(radians(45 + 44 * numbers.signed_unit()));
    }
    return light;
}

/// Whether the view shows the point, and where: pixel and distance along the axis.
bool find_pixel(const RenderView& view, const Vec3& point, Vec3& pixel) {
    const Vec4 clip = view.clip_from_world * Vec4(point, 1);
    pixel = {
        (clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(view.width),
        (clip.y / clip.w * 0.5f + 0.5f) * static_cast<float>(view.height), clip.w};
    return clip.w >= view.near && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w;
}

Status measure_lists(HeadlessRenderer& headless, QualityReport& report) {
    Result<oracle::ClusterReadback> readback = oracle::ClusterReadback::create(*headless.device);
    if (!readback) {
        return readback.error();
    }
    Numbers numbers(5);
    int tests = 0;
    int reaching = 0;
    int listed_tests = 0;
    int missing = 0;
    while (tests < kRandomTests || reaching < kReachingTests) {
        const RenderView view = quality_view(
            numbers.in_cube(15), numbers.in_cube(15), 333, 190,
            radians(70 + 40 * numbers.signed_unit()));
        LightList lights;
        for (int i = 0; i < kLightsAtOnce; ++i) {
            lights.reach.push_back(random_reach(numbers, i));
        }
        const oracle::ReadClusters lists = readback->run(view, lights);
        for (int k = 0; k < 400; ++k) {
            // Near a light, so that the test is not wasted on the dark.
            const LightReach& chosen = lights.reach[static_cast<std::size_t>(k % kLightsAtOnce)];
            const Vec3 point = chosen.center + numbers.in_cube(chosen.radius);
            Vec3 pixel;
            if (!find_pixel(view, point, pixel)) {
                continue;
            }
            const auto list = lists.of(cell_of(lists.shape, pixel.x, pixel.y, pixel.z));
            for (std::uint32_t i = 0; i < lights.reach.size(); ++i) {
                const bool reaches = oracle::reaches(lights.reach[i], point);
                const bool listed = std::find(list.begin(), list.end(), i) != list.end();
                ++tests;
                reaching += reaches ? 1 : 0;
                listed_tests += listed ? 1 : 0;
                missing += reaches && !listed ? 1 : 0;
            }
        }
    }
    report.rows.push_back(
        {fmt::format("lights that reach a point and are not in its list, of {} tests", tests),
         static_cast<double>(missing), QualityBound::AtMost, 0});
    report.rows.push_back(
        {"lights in a point's list, for each that reaches it",
         static_cast<double>(listed_tests) / reaching});
    return Done{};
}

}  // namespace

Result<QualityReport> measure_lights_quality(HeadlessRenderer& headless) {
    QualityReport report;
    measure_pictures(headless, report);
    const Status lists = measure_lists(headless, report);
    if (!lists) {
        return lists.error();
    }
    return report;
}

}  // namespace limn
