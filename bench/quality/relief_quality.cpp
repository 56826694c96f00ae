#include "bench/oracles/light_oracle.h"
#include "bench/quality/quality_scene.h"
#include "content/bake/tile_surface.h"
#include "content/make/models/shapes.h"
#include "content/make/patterns/relief_patterns.h"
#include "ecs/components/light.h"
#include "ecs/components/shadow.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace limn::relief_quality {
namespace {

using oracle::DVec3;

// A slab of 2 x 2 m in z = 0, one tile of the map, seen from 20 degrees above it.
constexpr int kWidth = 384;
constexpr int kHeight = 256;
constexpr int kTexels = 256;
constexpr float kTile = 2;               ///< [m]
constexpr float kDepth = 0.06f * kTile;  ///< of the relief [m]
constexpr float kTexel = kTile / kTexels;
constexpr Vec3 kAlbedo = {0.8f, 0.75f, 0.7f};
const PointLight kLamp = {.color = {1, 0.95f, 0.9f}, .intensity = 3, .radius = 6};
constexpr Vec3 kLampPosition = {-0.7f, 0.6f, 0.9f};
constexpr Vec3 kShadowLamp = {-1.6f, 0.5f, 1.1f};

ImageData carving() {
    return make_rosettes({.image = {.size = kTexels}, .relief = 0.06f, .worn = 0}).relief;
}

HeightMap heights_of_map(const ImageData& relief) {
    HeightMap map = {.width = relief.width, .height = relief.height, .repeats = true};
    for (std::size_t i = 3; i < relief.pixels.size(); i += 4) {
        map.heights.push_back(1 - static_cast<float>(relief.pixels[i]) / 255);
    }
    return map;
}

/// The displaced slab: rays in meters.
class DisplacedSlab {
  public:
    explicit DisplacedSlab(const HeightMap& heights)
        : tile_(tile_of(heights, kDepth / kTile)), caster_(tile_) {}

    struct Hit {
        DVec3 point;
        DVec3 normal;
    };
    [[nodiscard]] std::optional<Hit> nearest(const DVec3& origin, const DVec3& direction) const {
        const MeshRay ray = {
            .origin = to_tile(origin), .direction = Vec3(direction) / kTile, .max_t = 100};
        const std::optional<RayHit> hit = caster_.nearest(ray);
        return hit ? std::optional(
                   Hit{origin + double(hit->t) * direction, DVec3(normal_at(tile_, *hit))})
                   : std::nullopt;
    }

  private:
    static Vec3 to_tile(const DVec3& p) {
        return {(Vec2(p.x, p.y) + 0.5f * kTile) / kTile, static_cast<float>(p.z) / kTile};
    }
    TileSurface tile_;
    TileCaster caster_;
};

RenderView grazing_view() {
    const float angle = radians(20.0f);
    return quality_view(
        Vec3(0.1f, -1.4f * std::cos(angle), 1.4f * std::sin(angle)), {0.1f, 0, 0}, kWidth, kHeight,
        radians(36.0f));
}

/// What the view ray of each pixel meets; empty where that is not well within the slab.
std::vector<std::optional<DisplacedSlab::Hit>>
hits_of(const DisplacedSlab& slab, const RenderView& view) {
    std::vector<std::optional<DisplacedSlab::Hit>> hits;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const DVec3 ray = pixel_ray(view, x, y);
            const DVec3 eye = eye_of(view);
            const DVec3 entry = eye - ray * (eye.z / ray.z);
            const bool within = ray.z < 0 && std::max(std::abs(entry.x), std::abs(entry.y)) < 0.98;
            hits.push_back(within ? slab.nearest(eye, ray) : std::nullopt);
        }
    }
    return hits;
}

/// The slab by a method.
void place_slab(QualityScene& scene, const ImageData& relief, SurfaceDetail detail) {
    Material stone = {
        .shading = ShadingModel::Blinn, .base_color = Vec4(kAlbedo, 1), .specular = {0, 0, 0}};
    stone.detail = detail;
    stone.relief_depth = kDepth;
    stone.relief_steps = 128;
    stone.relief_refinements = 8;
    stone.relief_texture = {.image = scene.add(relief)};
    scene.place(scene.add(quality_square()), scene.add(stone), placed_at({0, 0, 0}));
}

// ---- color

gpu::FloatImage
lit_image(std::span<const std::optional<DisplacedSlab::Hit>> hits, const RenderView& view) {
    gpu::FloatImage image{.width = kWidth, .height = kHeight, .channels = 3, .pixels = {}};
    for (const auto& hit : hits) {
        DVec3 color(0);
        if (hit) {
            const oracle::Arriving light =
                oracle::arrive(kLamp, DVec3(kLampPosition), hit->point, hit->normal);
            const DVec3 to_camera = glm::normalize(eye_of(view) - hit->point);
            color = oracle::blinn(
                {.ambient = DVec3(0),
                 .diffuse = DVec3(kAlbedo),
                 .specular = DVec3(0),
                 .shininess = 1},
                DVec3(0), std::span(&light, 1), hit->normal, to_camera);
        }
        for (int c = 0; c < 3; ++c) {
            image.pixels.push_back(static_cast<float>(color[c]));
        }
    }
    return image;
}

/// Mean absolute difference where there are hits, of the mean of `expected` [%].
double mean_difference(
    const gpu::FloatImage& found, const gpu::FloatImage& expected,
    std::span<const std::optional<DisplacedSlab::Hit>> hits) {
    double sum = 0;
    double mean = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        for (std::size_t c = 0; hits[i] && c < 3; ++c) {
            const double value = expected.pixels[3 * i + c];
            const auto channels = static_cast<std::size_t>(found.channels);
            sum += std::abs(static_cast<double>(found.pixels[channels * i + c]) - value);
            mean += value;
        }
    }
    return 100 * sum / std::max(mean, 1e-9);
}

void compare_methods(
    HeadlessRenderer& headless, const ImageData& relief, const DisplacedSlab& slab,
    QualityReport& report) {
    const RenderView view = grazing_view();
    const auto hits = hits_of(slab, view);
    const gpu::FloatImage expected = lit_image(hits, view);
    const auto measure = [&](const char* name, SurfaceDetail detail) {
        QualityScene scene;
        place_slab(scene, relief, detail);
        scene.add_light(kLamp, placed_at(kLampPosition));
        const gpu::FloatImage found = scene.radiance(headless, view);
        report.images.push_back({name, displayed(found), displayed(expected)});
        return mean_difference(found, expected, hits);
    };
    const double bump = measure("bump mapping at 20 degrees", SurfaceDetail::Bump);
    const double parallax = measure("parallax mapping", SurfaceDetail::Parallax);
    const double searched = measure("relief", SurfaceDetail::Relief);
    const double cones = measure("relief by cones", SurfaceDetail::Cone);
    report.inform("bump mapping: mean difference, of the mean", bump, "%");
    report.at_most(
        "parallax mapping: mean difference, less than bump mapping", parallax, bump, "%");
    report.at_most("relief: mean difference, less than parallax mapping", searched, parallax, "%");
    report.at_most("relief by cones: mean difference, less than parallax", cones, parallax, "%");
}

// ---- positions

void compare_positions(
    HeadlessRenderer& headless, const ImageData& relief, const DisplacedSlab& slab,
    QualityReport& report) {
    const RenderView view = grazing_view();
    const auto hits = hits_of(slab, view);
    for (const auto& [name, detail] :
         {std::pair("relief", SurfaceDetail::Relief), std::pair("cones", SurfaceDetail::Cone)}) {
        QualityScene scene;
        place_slab(scene, relief, detail);
        const FrameOutput frame =
            render_frame(*headless.renderer, scene.world, view, {.aovs = {"depth"}});
        const gpu::FloatImage depth = gpu::read_floats(*frame.aovs[0].texture);
        std::vector<double> errors;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const auto& hit = hits[static_cast<std::size_t>(y * kWidth + x)];
                if (hit) {
                    const DVec3 point =
                        eye_of(view) + double(depth.at(x, y, 0)) * pixel_ray(view, x, y);
                    errors.push_back(glm::length(point - hit->point) / double(kTexel));
                }
            }
        }
        std::ranges::sort(errors);
        const auto within = std::ranges::upper_bound(errors, 0.5) - errors.begin();
        const auto count = static_cast<double>(errors.size());
        report.at_most(
            fmt::format("{}: median error of the point that is hit, in texels", name),
            errors[errors.size() / 2], 0.5);
        report.at_least(
            fmt::format("{}: points within half a texel", name),
            100 * static_cast<double>(within) / count, 90, "%");
    }
}

// ---- shadows

/// The slab's shadow on itself: by a map, or by a second ray per pixel.
void compare_shadows(
    HeadlessRenderer& headless, const ImageData& relief, const DisplacedSlab& slab,
    ReliefShadow method, QualityReport& report) {
    const bool by_ray = method == ReliefShadow::Ray;
    const RenderView view = quality_view({0, -1.2f, 1.6f}, {0, 0, 0}, kWidth, kHeight, 0.8f);
    const auto hits = hits_of(slab, view);
    const SpotLight lamp = {
        .color = {1, 1, 1},
        .intensity = 8,
        .radius = 8,
        .inner_angle = radians(42.0f),
        .outer_angle = radians(45.0f)};
    QualityScene scene;
    place_slab(scene, relief, SurfaceDetail::Relief);
    scene.world.resource<Assets>().materials[0].relief_shadow = method;
    const Entity light = scene.add_light(lamp, look_at(kShadowLamp, {0, 0, 0}));
    const gpu::FloatImage open = scene.radiance(headless, view);
    scene.world.add(light, Shadow{.resolution = 2048});
    const gpu::FloatImage shaded = scene.radiance(headless, view);
    int same = 0;
    int count = 0;
    gpu::FloatImage expected{.width = kWidth, .height = kHeight, .channels = 3, .pixels = {}};
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const auto channels = static_cast<std::size_t>(open.channels);
        const float lit = open.pixels[channels * i];
        bool shadowed = false;
        if (hits[i] && lit > 1e-3f) {
            const DVec3 to_light = DVec3(kShadowLamp) - hits[i]->point;
            shadowed = slab.nearest(hits[i]->point + 1e-3 * hits[i]->normal, to_light).has_value();
            same += (shaded.pixels[channels * i] < 0.5f * lit) == shadowed ? 1 : 0;
            ++count;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            expected.pixels.push_back(shadowed ? 0.0f : open.pixels[channels * i + c]);
        }
    }
    const double shared = 100.0 * same / std::max(count, 1);
    const std::string name = fmt::format("shadow on itself by a {}", by_ray ? "second ray" : "map");
    report.at_least(fmt::format("{}: pixels as by Embree", name), shared, 98, "%");
    report.images.push_back({name, displayed(shaded), displayed(expected)});
}

// ---- silhouettes

/// Moves the vertices of a mesh in by the depth of its map, as texture coordinates times `tiles`
/// read it.
MeshData displaced(MeshData mesh, const HeightMap& heights, const Vec2& tiles, float depth) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec2 at = glm::fract(mesh.uvs[i] * tiles) * static_cast<float>(kTexels) - 0.5f;
        const IVec2 texel = glm::floor(at);
        const Vec2 part = at - Vec2(texel);
        const float low =
            glm::mix(heights.at(texel.x, texel.y), heights.at(texel.x + 1, texel.y), part.x);
        const float high = glm::mix(
            heights.at(texel.x, texel.y + 1), heights.at(texel.x + 1, texel.y + 1), part.x);
        mesh.positions[i] -= mesh.normals[i] * depth * (1 - glm::mix(low, high, part.y));
    }
    return mesh;
}

struct CurvedBody {
    const char* name;
    MeshData coarse;  ///< that is drawn
    MeshData fine;    ///< that is displaced
    Vec2 tiles;
    float depth;
    RenderView view;
};

std::vector<CurvedBody> curved_bodies() {
    const auto view = [](float distance, float half_height) {
        return quality_view(
            {0, 0, distance}, {0, 0, 0}, 512, 512, 2 * std::atan(half_height / distance));
    };
    // In coarse mip levels an outline is that of the mean depth. The ends of the column are outside
    // of the image.
    return {
        {"ball",
         make_sphere({.radius = 1, .segments = 96, .rings = 48}),
         make_sphere({.radius = 1, .segments = 1200, .rings = 600}),
         {4, 2},
         0.05f,
         view(6, 1.1f)},
        {"column",
         make_cylinder(
             {.radius = 0.5f, .height = 4, .segments = 96, .divisions = 8, .caps = false}),
         make_cylinder(
             {.radius = 0.5f, .height = 4, .segments = 1200, .divisions = 800, .caps = false}),
         {3, 4},
         0.04f,
         view(6, 0.7f)}};
}

void compare_silhouettes(
    HeadlessRenderer& headless, const ImageData& relief, const HeightMap& heights,
    QualityReport& report) {
    for (const CurvedBody& body : curved_bodies()) {
        QualityScene scene;
        Material stone = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        stone.detail = SurfaceDetail::Silhouette;
        stone.relief_depth = body.depth;
        stone.relief_steps = 128;
        stone.relief_refinements = 8;
        stone.relief_texture = {.image = scene.add(relief), .scale = body.tiles};
        scene.place(scene.add(body.coarse), scene.add(stone), placed_at({0, 0, 0}));
        const gpu::FloatImage found = scene.radiance(headless, body.view);
        const MeshData mesh = displaced(body.fine, heights, body.tiles, body.depth);
        const RayCaster caster(mesh.positions, mesh.indices);
        gpu::FloatImage expected{
            .width = body.view.width, .height = body.view.height, .channels = 3, .pixels = {}};
        int both = 0;
        int either = 0;
        for (int y = 0; y < body.view.height; ++y) {
            for (int x = 0; x < body.view.width; ++x) {
                const MeshRay ray = {
                    .origin = Vec3(eye_of(body.view)),
                    .direction = Vec3(pixel_ray(body.view, x, y))};
                const bool hit = caster.nearest(ray).has_value();
                const bool drawn = found.at(x, y, 0) > 0.5f;
                both += hit && drawn ? 1 : 0;
                either += hit || drawn ? 1 : 0;
                expected.pixels.insert(expected.pixels.end(), 3, hit ? 1.0f : 0.0f);
            }
        }
        report.at_least(
            fmt::format("{}: shared by both outlines, of either (IoU)", body.name),
            static_cast<double>(both) / std::max(either, 1), 0.99);
        report.images.push_back(
            {fmt::format("outline of a {}", body.name), displayed(found), displayed(expected)});
    }
}

Status measure_relief(HeadlessRenderer& headless, QualityReport& report) {
    const ImageData relief = carving();
    const HeightMap heights = heights_of_map(relief);
    const DisplacedSlab slab(heights);
    compare_methods(headless, relief, slab, report);
    compare_positions(headless, relief, slab, report);
    compare_shadows(headless, relief, slab, ReliefShadow::Map, report);
    compare_shadows(headless, relief, slab, ReliefShadow::Ray, report);
    compare_silhouettes(headless, relief, heights, report);
    return Done{};
}

const RegisterQuality kRegistered(
    "relief",
    "rays that Embree casts at the displaced mesh, in color, position, shadow and outline",
    measure_relief);

}  // namespace
}  // namespace limn::relief_quality
