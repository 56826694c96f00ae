#pragma once

#include "ecs/base/math.h"

namespace limn {

struct RenderView;
struct LightReach;

// What part of the picture a light can reach: a rectangle of pixels (shadow.light-scissor) and a
// range of depths (shadow.depth-bounds). What lies outside is neither lit nor in shadow of it, so
// that no volume needs to be counted there. Both are exact for spheres that lie before the camera
// and at most too large otherwise.

/// Pixels x .. x + width - 1 from the left, y .. y + height - 1 from the bottom, as glScissor has
/// them. Depths are reversed, as the depth buffer has them.
struct LightBounds {
    int x = 0;
    int y = 0;
    int width = 0;   ///< 0: the light reaches nothing in the picture
    int height = 0;  ///< [px]
    float depth_min = 0;
    float depth_max = 1;
    bool operator==(const LightBounds&) const = default;
};
[[nodiscard]] inline bool is_empty(const LightBounds& bounds) {
    return bounds.width <= 0 || bounds.height <= 0;
}

/// Between which slopes x / -z the part of a sphere beyond the near plane is seen.
struct SlopeRange {
    float low = -INFINITY;
    float high = INFINITY;
};
/// Of the sphere's middle only its coordinate along the axis asked for and z count.
[[nodiscard]] SlopeRange sphere_slopes(float x, float z, float radius, float near);

/// Of a sphere in the world; an infinite radius gives the whole picture.
[[nodiscard]] LightBounds light_bounds(const RenderView& view, const Vec3& center, float radius);

/// The least sphere known to hold all that the light reaches: of a narrow cone one about its
/// middle.
struct ReachSphere {
    Vec3 center;
    float radius = 0;
};
[[nodiscard]] ReachSphere reach_sphere(const LightReach& reach);

/// Whether the light can reach something in the box: sphere against box, and for spots the cone
/// against the sphere around the box (shadow.caster-cull).
[[nodiscard]] bool reaches_box(const LightReach& reach, const Bounds& box);

}  // namespace limn
