#include "content/app/quality_water_reflection.h"

#include "content/app/quality_scene.h"
#include "ecs/base/optics.h"
#include "ecs/components/environment.h"
#include "ecs/components/water.h"
#include "ecs/components/water_look.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr float kIndex = 1.333f;
const Vec3 kEye = {0.5f, 1.7f, 4};
const Vec3 kTarget = {0, 0.7f, -2};

/// Colored things that stand in and hang over still, dark water at y = 0.
void build_shore(QualityScene& scene) {
    scene.world.insert_resource(Environment{
        .sky = SkyKind::Uniform,
        .zenith = Vec3(0.45f),
        .horizon = Vec3(0.45f),
        .ground = Vec3(0.45f),
        .visible = true});
    MeshData board = quality_square();
    board.colors = {
        {0.9f, 0.2f, 0.1f, 1}, {0.1f, 0.8f, 0.2f, 1}, {0.2f, 0.3f, 0.9f, 1}, {0.9f, 0.9f, 0.2f, 1}};
    const MeshId mesh = scene.add(std::move(board));
    const MaterialId plain =
        scene.add(Material{.shading = ShadingModel::Unlit, .double_sided = true});
    const auto stand = [&](const Vec3& at, float turn, const Vec3& size) {
        scene.place(mesh, plain, affine_from(at, glm::angleAxis(turn, Vec3(0, 1, 0)), size));
    };
    stand({0, 1.2f, -6}, 0, {5, 1.4f, 1});
    stand({-2.2f, 0.3f, -3}, 0.5f, {0.5f, 0.8f, 1});
    stand({1.6f, 0.6f, -2.5f}, -0.4f, {0.4f, 0.4f, 1});
    stand({0.2f, 1.5f, -4}, 0.1f, {0.3f, 0.3f, 1});
}

gpu::FloatImage
depth_of(HeadlessRenderer& headless, const QualityScene& scene, const RenderView& view) {
    const FrameOutput out =
        render_frame(*headless.renderer, scene.world, view, {.aovs = {"depth"}});
    return gpu::read_floats(*out.aovs[0].texture);
}

/// One meter along the axis of the view, through the middle of a pixel; row 0 is the top one.
Vec3 ray_through(const RenderView& view, int x, int y) {
    const Vec2 ndc = (Vec2(x, kHeight - 1 - y) + 0.5f) / Vec2(kWidth, kHeight) * 2.0f - 1.0f;
    const auto& pose = view.world_from_camera.row;
    const Vec3 in_camera(ndc * view.tangent, -1);
    return {
        glm::dot(Vec3(pose[0]), in_camera), glm::dot(Vec3(pose[1]), in_camera),
        glm::dot(Vec3(pose[2]), in_camera)};
}

/// What each pixel of water mirrors, by the oracle, and whether the picture holds it.
struct MirroredTruth {
    gpu::FloatImage radiance;
    std::vector<bool> is_water;
    std::vector<bool> is_held;
};

Vec3 mirrored(const Vec3& p) {
    return {p.x, -p.y, p.z};
}

MirroredTruth trace_truth(HeadlessRenderer& headless, QualityScene& shore, const RenderView& view) {
    // The mirrored camera's picture is upside down.
    const RenderView below = quality_view(mirrored(kEye), mirrored(kTarget), kWidth, kHeight, 1);
    const gpu::FloatImage seen = shore.radiance(headless, below);
    const gpu::FloatImage seen_depth = depth_of(headless, shore, below);
    const gpu::FloatImage shown_depth = depth_of(headless, shore, view);
    MirroredTruth truth = {seen, {}, {}};
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const int row = kHeight - 1 - y;
            const auto channels = static_cast<std::size_t>(seen.channels);
            const std::size_t to = (static_cast<std::size_t>(y) * kWidth + x) * channels;
            const std::size_t from = (static_cast<std::size_t>(row) * kWidth + x) * channels;
            std::copy_n(seen.pixels.begin() + from, channels, truth.radiance.pixels.begin() + to);
            const Vec3 ray = ray_through(view, x, y);
            const float surface = ray.y < -1e-3f ? kEye.y / -ray.y : kNoDepth;
            truth.is_water.push_back(surface < shown_depth.at(x, y, 0) && surface < 60);
            // Where the camera itself would see what is mirrored.
            const float away = seen_depth.at(x, row, 0);
            const Vec3 point = mirrored(kEye) + ray_through(below, x, row) * away;
            const Vec4 clip = view.clip_from_world * Vec4(point, 1);
            const Vec2 place =
                (0.5f + 0.5f * Vec2(clip.x, clip.y) / clip.w) * Vec2(kWidth, kHeight);
            const auto column = static_cast<int>(std::floor(place.x));
            const int line = kHeight - 1 - static_cast<int>(std::floor(place.y));
            const bool inside = away < kNoDepth && point.y > 0.03f && column >= 0 && column < kWidth
                                && line >= 0 && line < kHeight;
            truth.is_held.push_back(
                inside && std::abs(shown_depth.at(column, line, 0) - clip.w) < 0.02f * clip.w);
        }
    }
    return truth;
}

/// Decibels over the pixels that count, of radiance over the share that is mirrored.
double psnr_of(
    const gpu::FloatImage& picture, const MirroredTruth& truth, const std::vector<bool>& counts,
    const RenderView& view) {
    double squares = 0;
    double samples = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * kWidth + x;
            if (!truth.is_water[i] || !counts[i]) {
                continue;
            }
            const float share = fresnel(-glm::normalize(ray_through(view, x, y)).y, kIndex);
            for (int c = 0; c < 3; ++c) {
                squares += square(
                    static_cast<double>(picture.at(x, y, c) / share - truth.radiance.at(x, y, c)));
                samples += 1;
            }
        }
    }
    LIMN_CHECK(samples > kWidth * kHeight / 10);  // else there is nothing to compare
    return -10 * std::log10(std::max(squares / samples, 1e-12));
}

}  // namespace

void measure_water_reflections(HeadlessRenderer& headless, QualityReport& report) {
    QualityScene shore;
    build_shore(shore);
    const RenderView view = quality_view(kEye, kTarget, kWidth, kHeight, 1);
    const MirroredTruth truth = trace_truth(headless, shore, view);
    const Entity water = shore.world.create(
        Water{.refractive_index = kIndex, .absorption = Vec3(1000), .scattering = Vec3(0)},
        WorldTransform{placed_at({0, 0, 0})});
    const std::vector<bool> all(truth.is_water.size(), true);
    const auto measure = [&](const char* name, const WaterLook& look,
                             const std::vector<bool>& counts, double least) {
        shore.world.add(water, look);
        const gpu::FloatImage seen = shore.radiance(headless, view);
        shore.world.remove<WaterLook>(water);
        report.rows.push_back(
            {name, psnr_of(seen, truth, counts, view), QualityBound::AtLeast, least, "dB"});
        return seen;
    };
    const WaterLook planar = {.reflection = WaterReflection::Planar, .map_scale = 1};
    const gpu::FloatImage seen =
        measure("still water, planar reflection against a mirrored camera", planar, all, 45);
    measure(
        "the same in half as many pixels a side", {.reflection = WaterReflection::Planar}, all, 30);
    measure("out of the picture, where it holds what is mirrored", {}, truth.is_held, 20);
    report.pictures.push_back(
        {"still water, planar, and a mirrored camera's picture", displayed(seen),
         displayed(truth.radiance)});
}

}  // namespace limn
