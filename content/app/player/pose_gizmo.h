#pragma once

#include "content/app/player/pick.h"
#include "ecs/base/math.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace limn {

struct RenderView;

// Rings about the three axes of a joint that turn it when dragged (char.fk-keypose), apart from how
// they are drawn. Pixels count from the top left of the window.

inline constexpr float kGizmoPickPixels = 9.0f;
inline constexpr float kJointPickPixels = 14.0f;

/// Three rings; sizes in the world.
struct PoseGizmo {
    Vec3 center = {0, 0, 0};
    std::array<Vec3, 3> axes = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};  ///< unit
    float radius = 0.1f;                                                       ///< [m]
};

/// The rings of a joint, as large in the image at any distance.
[[nodiscard]] PoseGizmo make_gizmo(const RenderView& view, const Affine& world_from_joint);

/// Image position of a point; none behind the camera.
[[nodiscard]] std::optional<Vec2>
window_point(const RenderView& view, const Vec3& point, const IVec2& window);

/// Point `angle` [rad] around ring `axis`.
[[nodiscard]] Vec3 ring_point(const PoseGizmo& gizmo, int axis, float angle);

/// The ring nearest to the pointer within kGizmoPickPixels.
[[nodiscard]] std::optional<int>
pick_ring(const PoseGizmo& gizmo, const RenderView& view, const Vec2& pointer, const IVec2& window);

/// The angle [rad] around ring `axis` at which the ray meets its plane; none if it is nearly in the
/// plane.
[[nodiscard]] std::optional<float> ring_angle(const PoseGizmo& gizmo, int axis, const Ray& ray);

/// Index of the point nearest to the pointer within kJointPickPixels; among those that coincide,
/// the last.
[[nodiscard]] std::optional<std::uint16_t> pick_joint(
    std::span<const Vec3> points, const RenderView& view, const Vec2& pointer, const IVec2& window);

}  // namespace limn
