#include "render/speed_line_list.h"

#include "ecs/components/time.h"
#include "ecs/world.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cstdint>

namespace limn {
namespace {

/// Light and opacity that can be reckoned with; what is no number is none.
Vec4 sound_color(const Vec4& color) {
    constexpr float kMostLight = 65504.0f;
    const auto within = [](float x, float most) { return x > 0.0f ? std::min(x, most) : 0.0f; };
    return {
        within(color.x, kMostLight), within(color.y, kMostLight), within(color.z, kMostLight),
        within(color.w, 1.0f)};
}

}  // namespace

void append_speed_lines(
    const MeshData& mesh, const Affine& now, const Affine& before, float seconds,
    const SpeedLines& settings, std::vector<SpeedLine>& lines) {
    const auto vertices =
        static_cast<std::int64_t>(std::min(mesh.positions.size(), mesh.normals.size()));
    const std::int64_t count = std::clamp<std::int64_t>(settings.count, 0, vertices);
    // A surface that a matrix mirrors is turned inside out, and its normals with it.
    const Mat3 linear(to_mat4(now));
    const Mat3 cofactor(
        glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
        glm::cross(linear[0], linear[1]));
    const float side = glm::determinant(linear) < 0.0f ? -1.0f : 1.0f;
    const Vec4 color = sound_color(settings.color);
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

void collect_speed_lines(
    const World& world, const RenderView& view, std::vector<SpeedLine>& lines) {
    lines.clear();
    const auto* assets = world.find_resource<Assets>();
    const auto* time = world.find_resource<FrameTime>();
    if (assets == nullptr) {
        return;
    }
    const float step = time != nullptr ? time->step : FrameTime{}.step;
    const float seconds = step * (view.alpha - view.alpha_before);
    world
        .query<
            const SpeedLines, const MeshInstance, const WorldTransform,
            const PreviousWorldTransform>()
        .each([&](const SpeedLines& settings, const MeshInstance& instance,
                  const WorldTransform& now, const PreviousWorldTransform& before) {
            if (instance.mesh.index < assets->meshes.size()) {
                append_speed_lines(
                    assets->meshes[instance.mesh.index],
                    mix_affine(before.world, now.world, view.alpha),
                    mix_affine(before.world, now.world, view.alpha_before), seconds, settings,
                    lines);
            }
        });
}

}  // namespace limn
