#include "render/lens/dazzle_pass.h"

#include "ecs/components/light.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/settings.h"
#include "render/shaders/dazzle_gpu.h"
#include "render/shaders/disk_visibility_gpu.h"
#include "render/shaders/fullscreen_gpu.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: engine.obfuscating-point

namespace limn {
namespace {

constexpr std::size_t kMaxPoints = 16;

/// Between two vectors of any length [rad], exact for small angles too; 0 if one has no length.
float angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

float dazzle_weight(const Dazzle& dazzle, float off_axis) {
    if (!(off_axis < dazzle.angle)) {
        return 0;
    }
    return finite_or(dazzle.opacity * (1 - off_axis / dazzle.angle), 0);
}

bool DazzleEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const Dazzle, const WorldTransform>().empty();
}

Result<DazzleEffect> DazzleEffect::create(gpu::Device& device, const RenderSettings&) {
    return DazzleEffect{
        LIMN_TRY(load_fullscreen(device, "disk_visibility.frag")),
        LIMN_TRY(load_fullscreen(device, "dazzle.frag"))};
}

void DazzleEffect::collect(FrameData& frame) {
    points.clear();
    sources.clear();
    const RenderView& view = frame.camera;
    const Vec3 eye = transform_point(view.world_from_camera, Vec3(0));
    const Vec3 forward = transform_vector(view.world_from_camera, Vec3(0, 0, -1));
    frame.world->query<const Dazzle, const WorldTransform, Optional<const DirectionalLight>>().each(
        [&](const Dazzle& settings, const WorldTransform& pose, const DirectionalLight* light) {
            const Dazzle dazzle = within_ranges(settings);
            const bool distant = light != nullptr;
            const Vec4 at = distant ? Vec4(transform_vector(pose.world, Vec3(0, 0, 1)), 0)
                                    : Vec4(transform_point(pose.world, Vec3(0)), 1);
            const Vec3 toward = distant ? Vec3(at) : Vec3(at) - eye;
            const float weight = dazzle_weight(dazzle, angle_between(forward, toward));
            const Vec4 clip = view.clip_from_world * at;
            if (weight <= 0 || points.size() >= kMaxPoints || !is_finite(toward)) {
                return;
            }
            // A point at or behind the eye cannot be occluded.
            const bool ahead = distant || clip.w > view.near;
            const Vec2 uv = ahead ? 0.5f * Vec2(clip) / clip.w + 0.5f : Vec2(0.5f);
            points.push_back({dazzle.color, weight});
            sources.push_back(
                {uv,
                 distant ? 0.0f
                 : ahead ? view.near / clip.w
                         : INFINITY,
                 0.5f * dazzle.source_size * static_cast<float>(view.height)});
        });
    point_records.upload(*frame.ring, points);
    source_records.upload(*frame.ring, sources);
}

void DazzleEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    if (points.empty()) {
        return;
    }
    const TextureId visible =
        create_target(graph, "dazzle visibility", GL_R32F, {static_cast<int>(points.size()), 1});
    add_fullscreen_pass(
        graph, "dazzle visibility", {sampled(view.gbuffer.depth, layout::kDiskDepthUnit)},
        {discarded(visible)}, visibility, [this](PassContext& context, const gpu::Program&) {
            source_records.bind(context.device(), layout::kDiskSourcesUnit);
        });
    const TextureId dazzled = create_like(graph, "dazzled radiance", view.radiance);
    add_fullscreen_pass(
        graph, "dazzle",
        {sampled(view.radiance, layout::kSourceUnit), sampled(visible, layout::kVisibilityUnit)},
        {discarded(dazzled)}, program, [this](PassContext& context, const gpu::Program& shader) {
            point_records.bind(context.device(), layout::kDazzlePointsUnit);
            shader.set("count", static_cast<int>(points.size()));
        });
    view.radiance = dazzled;
}

}  // namespace limn
