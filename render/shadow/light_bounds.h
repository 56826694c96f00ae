#pragma once

#include "ecs/base/math.h"

namespace limn {

struct RenderView;
struct LightRange;

// Screen-space bounds of a light's range: a rectangle of pixels (shadow.light-scissor) and a range
// of depths (shadow.depth-bounds). Outside, nothing is lit or shadowed by it, so shadow volumes
// need not be counted. Both are exact for spheres in front of the camera and conservative
// otherwise.

/// Pixels x .. x + width - 1 from the left, y .. y + height - 1 from the bottom, as for
/// glScissor. Depths are reversed, as in the depth buffer.
struct LightBounds {
    int x = 0;
    int y = 0;
    int width = 0;   ///< 0: nothing on screen is within its range
    int height = 0;  ///< [px]
    float depth_min = 0;
    float depth_max = 1;
    bool operator==(const LightBounds&) const = default;
};
[[nodiscard]] inline bool is_empty(const LightBounds& bounds) {
    return bounds.width <= 0 || bounds.height <= 0;
}

/// Extends the rectangle of `bounds` to `other`, with the range of depths of both.
void grow(LightBounds& bounds, const LightBounds& other);

/// Range of slopes x / -z of the part of a sphere beyond the near plane.
struct SlopeRange {
    float low = -INFINITY;
    float high = INFINITY;
};
/// `x`: coordinate of the sphere's center along the axis in question; `z`: its view-space z.
[[nodiscard]] SlopeRange sphere_slopes(float x, float z, float radius, float near);

/// For a sphere in world space; an infinite radius gives the whole screen.
[[nodiscard]] LightBounds light_bounds(const RenderView& view, const Vec3& center, float radius);

/// A tight bounding sphere of the light's range; that of a narrow cone is centered on its axis.
struct RangeSphere {
    Vec3 center;
    float radius = 0;
};
[[nodiscard]] RangeSphere range_sphere(const LightRange& range);

/// Whether the light can reach something in the box: sphere against box, and for spots also the
/// cone against the sphere around the box (shadow.caster-cull).
[[nodiscard]] bool reaches_box(const LightRange& range, const Bounds& box);

}  // namespace limn
