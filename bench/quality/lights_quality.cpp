#include "bench/oracles/cluster_oracle.h"
#include "bench/oracles/cluster_readback.h"
#include "bench/oracles/light_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/base/hash.h"
#include "ecs/base/rng.h"
#include "ecs/components/light.h"
#include "ecs/components/rendering.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::lights_quality {
namespace {

using oracle::DVec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kLamps = 300;
constexpr double kAlbedo = 0.8;
constexpr float kHalfFloor = 40;  ///< half the floor's side [m]
constexpr int kLightsAtOnce = 60;
constexpr int kRandomTests = 100000;
constexpr int kReachingTests = 10000;  ///< at least so many with a light that reaches the point

/// Seeded random numbers: the scene is the same in every run.
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

/// Lamps of all colors over the floor; every third is a spot light pointing down at a slant.
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

/// Radiance of the floor under all lamps.
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

/// The oracle's image of the floor z = 0, shifted by `shift` [px]; black beyond it.
gpu::FloatImage
oracle_image(const std::vector<Lamp>& lamps, const RenderView& view, const glm::dvec2& shift) {
    gpu::FloatImage image{.width = kWidth, .height = kHeight, .channels = 3, .pixels = {}};
    const DVec3 eye = eye_of(view);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const DVec3 ray = pixel_ray(view, x + shift.x, y + shift.y);
            const DVec3 point = eye - ray * (eye.z / ray.z);
            const bool on_floor =
                ray.z < 0 && std::abs(point.x) < kHalfFloor && std::abs(point.y) < kHalfFloor;
            const DVec3 color = on_floor ? reflected(lamps, point) : DVec3(0);
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<float>(color[c]));
            }
        }
    }
    return image;
}

/// Largest difference of any channel from the values that it has in `allowed`, or between them.
float largest_excess(const ColorImage& found, const std::vector<ColorImage>& allowed) {
    float largest = 0;
    for (std::size_t i = 0; i < found.pixels.size(); ++i) {
        Vec3 low = allowed[0].pixels[i];
        Vec3 high = low;
        for (const ColorImage& image : allowed) {
            low = glm::min(low, image.pixels[i]);
            high = glm::max(high, image.pixels[i]);
        }
        const Vec3 excess = glm::max(low - found.pixels[i], found.pixels[i] - high);
        largest = std::max({largest, excess.x, excess.y, excess.z});
    }
    return largest;
}

void measure_images(HeadlessRenderer& headless, QualityReport& report) {
    constexpr const char* kMethods[kLightMethods] = {
        "clustered", "a full-screen pass per light", "light volumes", "per object, its lights",
        "per light, its objects"};
    const std::vector<Lamp> lamps = make_lamps();
    QualityScene scene;
    const auto gray = static_cast<float>(kAlbedo);
    const MaterialId matte = scene.add(Material{
        .shading = ShadingModel::Blinn,
        .base_color = {gray, gray, gray, 1},
        .specular = {0, 0, 0}});
    scene.place(scene.add(quality_square()), matte, placed_at({0, 0, 0}, kHalfFloor));
    for (const Lamp& lamp : lamps) {
        lamp.is_spot ? scene.add_light(lamp.spot, lamp.pose)
                     : scene.add_light(lamp.point, lamp.pose);
    }
    // At a slant, so that the floor crosses many depth slices.
    const RenderView view = quality_view({0, -13, 4}, {0, -2, 0}, kWidth, kHeight, radians(60.0f));
    const ColorImage expected = displayed(oracle_image(lamps, view, {0, 0}));
    // Hardware may snap vertices to 1/256 of a pixel, which moves what is in between by half of it:
    // 4 of 255 at the rims of cones in the dark.
    std::vector<ColorImage> allowed = {expected};
    if (!headless.device->caps().software) {
        for (const glm::dvec2& corner : {glm::dvec2(-1), {1, -1}, {-1, 1}, {1, 1}}) {
            allowed.push_back(displayed(oracle_image(lamps, view, corner / 512.0)));
        }
    }
    for (int method = 0; method < kLightMethods; ++method) {
        scene.world.insert_resource(Rendering{static_cast<LightMethod>(method)});
        const ColorImage found = displayed(scene.radiance(headless, view));
        report.at_most(
            fmt::format("{} lights, {}: largest difference on screen", kLamps, kMethods[method]),
            255.0 * static_cast<double>(largest_excess(found, allowed)), 1, "/ 255");
        if (method == 0) {
            report.images.push_back({fmt::format("{} lights, clustered", kLamps), found, expected});
        }
    }
}

/// A light of random reach; every third is a spot light.
LightRange random_reach(Numbers& numbers, int i) {
    LightRange light = {numbers.in_cube(25), std::exp2(3 * numbers.signed_unit())};
    if (i % 3 == 0) {
        light.axis = normalize_or(numbers.in_cube(1), {0, 1, 0});
        light.cosine = std::cos(radians(45 + 44 * numbers.signed_unit()));
    }
    return light;
}

/// Whether the point is in view; `pixel`: its pixel coordinates and distance along the view axis.
bool find_pixel(const RenderView& view, const Vec3& point, Vec3& pixel) {
    const Vec4 clip = view.clip_from_world * Vec4(point, 1);
    pixel = {
        (clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(view.width),
        (clip.y / clip.w * 0.5f + 0.5f) * static_cast<float>(view.height), clip.w};
    return clip.w >= view.near && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w;
}

Status measure_lists(HeadlessRenderer& headless, QualityReport& report) {
    oracle::ClusterReadback readback = LIMN_TRY(oracle::ClusterReadback::create(*headless.device));
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
        const oracle::ClusterReadbackLists lists = readback.run(view, lights);
        for (int k = 0; k < 400; ++k) {
            // Near a light, so that few tests fall on unlit points.
            const LightRange& chosen = lights.reach[static_cast<std::size_t>(k % kLightsAtOnce)];
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
    report.at_most(
        fmt::format("lights that reach a point but are missing from its list, of {} tests", tests),
        static_cast<double>(missing), 0);
    report.inform(
        "lights in a point's list per light that reaches it",
        static_cast<double>(listed_tests) / reaching);
    return Done{};
}

Status measure_lights(HeadlessRenderer& headless, QualityReport& report) {
    measure_images(headless, report);
    LIMN_TRY(measure_lists(headless, report));
    return Done{};
}

const RegisterQuality kRegistered(
    "lights", "brute-force lighting of each pixel's surface point, in double precision",
    measure_lights);

}  // namespace
}  // namespace limn::lights_quality
