#include "render/lens/speed_line_pass.h"

#include "ecs/components/time.h"
#include "ecs/world.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/shaders/speed_line_gpu.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cstdint>

// Techniques: post.speed-lines

namespace limn {
namespace {

/// Clamps radiance and opacity to valid ranges; NaN becomes 0.
Vec4 sanitize_color(const Vec4& color) {
    constexpr float kMaxRadiance = 65504.0f;
    const auto clamp = [](float x, float high) { return x > 0.0f ? std::min(x, high) : 0.0f; };
    return {
        clamp(color.x, kMaxRadiance), clamp(color.y, kMaxRadiance), clamp(color.z, kMaxRadiance),
        clamp(color.w, 1.0f)};
}

}  // namespace

void append_speed_lines(
    const MeshData& mesh, const Affine& now, const Affine& before, float seconds,
    const SpeedLines& settings, std::vector<SpeedLine>& lines) {
    const auto vertices =
        static_cast<std::int64_t>(std::min(mesh.positions.size(), mesh.normals.size()));
    const std::int64_t count = std::clamp<std::int64_t>(settings.count, 0, vertices);
    // A mirroring matrix turns the surface inside out, and the cofactor normals with it.
    const Mat3 linear(to_mat4(now));
    const Mat3 cofactor(
        glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
        glm::cross(linear[0], linear[1]));
    const float side = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
    const Vec4 color = sanitize_color(settings.color);
    for (std::int64_t i = 0; i < count && seconds > 0.0f; ++i) {
        const auto vertex = static_cast<std::size_t>(i * vertices / count);
        const Vec3 head = transform_point(now, mesh.positions[vertex]);
        const Vec3 velocity = (head - transform_point(before, mesh.positions[vertex])) / seconds;
        const Vec3 normal = side * (cofactor * mesh.normals[vertex]);
        const bool fast = glm::dot(velocity, velocity) > 0.0f
                          && glm::length(velocity) >= settings.min_speed;  // NaN is not fast
        if (fast && glm::dot(normal, velocity) < 0.0f) {
            lines.push_back(
                {.head = head,
                 .width = settings.width,
                 .tail = head - settings.length_scale * velocity,
                 .color = color});
        }
    }
}

Result<SpeedLineEffect> SpeedLineEffect::create(gpu::Device& device, const RenderSettings&) {
    return SpeedLineEffect{LIMN_TRY(
        device.shaders().load({.vertex = "speed_line.vert", .fragment = "speed_line.frag"}))};
}

bool SpeedLineEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const SpeedLines>().empty();
}

void SpeedLineEffect::collect(FrameData& frame) {
    const RenderView& view = frame.camera;
    const auto* time = frame.world->find_resource<FrameTime>();
    const float step = time != nullptr ? time->step : FrameTime{}.step;
    const float seconds = step * (view.alpha - view.previous_alpha);
    const std::vector<MeshData>& meshes = frame.assets->meshes;
    lines.clear();
    const auto* const jumps = frame.world->find_resource<StepJumps>();
    frame.world
        ->query<
            const SpeedLines, const MeshInstance, const WorldTransform,
            const PreviousWorldTransform>()
        .each([&](Entity entity, const SpeedLines& settings, const MeshInstance& instance,
                  const WorldTransform& now, const PreviousWorldTransform& before) {
            if (instance.mesh.index < meshes.size()) {
                append_speed_lines(
                    meshes[instance.mesh.index],
                    world_at(jumps, entity, now, &before, {view.alpha, view.alpha}),
                    world_at(jumps, entity, now, &before, {view.previous_alpha, view.alpha}),
                    seconds, settings, lines);
            }
        });
    records.upload(*frame.ring, lines);
}

void SpeedLineEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    if (lines.empty()) {
        return;
    }
    graph.add_pass(
        "speed lines", {depth_tested(view.gbuffer.depth)}, {view.radiance},
        [this, &view](PassContext& context) {
            context.device().use(gpu::Pipeline{
                program,
                {.depth = {.write = false}, .blend = gpu::kBlendPremultiplied, .cull = GL_NONE}});
            bind_view(context, view);
            records.bind(context.device(), layout::kSpeedLinesUnit);
            context.device().draw_ids(6 * static_cast<int>(lines.size()));
        });
}

}  // namespace limn
