#include "content/app/player/pose_gizmo.h"

#include "render/render_view.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.fk-keypose

namespace limn {
namespace {

constexpr float kGizmoSize = 0.11f;  ///< radius / distance from the camera, at a field of 60 deg
constexpr int kRingSteps = 64;

}  // namespace

PoseGizmo make_gizmo(const RenderView& view, const Affine& world_from_joint) {
    PoseGizmo gizmo;
    gizmo.center = transform_point(world_from_joint, Vec3(0));
    const Vec3 eye = transform_point(view.world_from_camera, Vec3(0));
    gizmo.radius = kGizmoSize * std::max(glm::distance(eye, gizmo.center), 1e-3f);
    for (int a = 0; a < 3; ++a) {
        Vec3 unit(0);
        unit[a] = 1;
        gizmo.axes[static_cast<std::size_t>(a)] =
            normalize_or(transform_vector(world_from_joint, unit), unit);
    }
    return gizmo;
}

std::optional<Vec2> window_point(const RenderView& view, const Vec3& point, const IVec2& window) {
    const Vec4 clip = view.unjittered_from_world * Vec4(point, 1);
    if (clip.w < view.near) {
        return std::nullopt;
    }
    return Vec2(0.5f + 0.5f * clip.x / clip.w, 0.5f - 0.5f * clip.y / clip.w) * Vec2(window);
}

Vec3 ring_point(const PoseGizmo& gizmo, int axis, float angle) {
    const Vec3 u = gizmo.axes[static_cast<std::size_t>((axis + 1) % 3)];
    const Vec3 v = glm::cross(gizmo.axes[static_cast<std::size_t>(axis)], u);
    return gizmo.center + gizmo.radius * (std::cos(angle) * u + std::sin(angle) * v);
}

std::optional<int> pick_ring(
    const PoseGizmo& gizmo, const RenderView& view, const Vec2& pointer, const IVec2& window) {
    std::optional<int> found;
    float nearest = kGizmoPickPixels;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < kRingSteps; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / kRingSteps;
            const auto at = window_point(view, ring_point(gizmo, axis, angle), window);
            const float distance = at ? glm::distance(*at, pointer) : nearest;
            if (distance < nearest) {
                nearest = distance;
                found = axis;
            }
        }
    }
    return found;
}

std::optional<float> ring_angle(const PoseGizmo& gizmo, int axis, const Ray& ray) {
    const Vec3 normal = gizmo.axes[static_cast<std::size_t>(axis)];
    const float slope = glm::dot(ray.direction, normal);
    if (std::abs(slope) < 0.03f) {
        return std::nullopt;
    }
    const float along = glm::dot(gizmo.center - ray.origin, normal) / slope;
    const Vec3 offset = ray.origin + along * ray.direction - gizmo.center;
    const Vec3 u = gizmo.axes[static_cast<std::size_t>((axis + 1) % 3)];
    const Vec3 v = glm::cross(normal, u);
    return std::atan2(glm::dot(offset, v), glm::dot(offset, u));
}

std::optional<std::uint16_t> pick_joint(
    std::span<const Vec3> points, const RenderView& view, const Vec2& pointer,
    const IVec2& window) {
    std::optional<std::uint16_t> found;
    float nearest = kJointPickPixels;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto at = window_point(view, points[i], window);
        const float distance = at ? glm::distance(*at, pointer) : nearest + 1;
        if (distance <= nearest) {
            nearest = distance;
            found = static_cast<std::uint16_t>(i);
        }
    }
    return found;
}

}  // namespace limn
