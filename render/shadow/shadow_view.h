#pragma once

#include "ecs/base/math.h"
#include "render/culling.h"
#include "render/render_view.h"
#include "render/shaders/shadow_gpu.h"
#include "render/shadow/shadow_atlas.h"

#include <array>

namespace limn {

// From where shadow maps are drawn. A view maps the world to clip space with reversed depth: of a
// spot and of a cube's face 1 at the near plane and near / distance beyond it, of a sun's cascade
// linear. The projective matrix of shadow.projective-matrix, which takes the world to texels of the
// atlas, is made of it by make_shadow_record().
//
// Around what a view must show it has a border of `guard` texels, so that a filter finds what it
// needs without leaving the view: cube faces overlap by it.

struct ShadowView {
    Mat4 clip_from_world{1.0f};
    Vec3 eye = {0, 0, 0};      ///< of a sun: of the middle of its map
    float reach = INFINITY;    ///< a caster farther than this from the eye shades nothing [m]
    int resolution = 512;      ///< side [texels], a power of two
    int guard = 2;             ///< [texels], < resolution / 2
    bool clamp_depth = false;  ///< what lies before the near plane is drawn on it
    /// Width of a penumbra [texels] for a difference in depth of 1 and a source of 1 m (or 1 rad).
    float penumbra = 0;
    Frustum shading = kEverywhere;  ///< of a cascade: what lies outside shades nothing that is seen
};

/// Half angle of a spot above which one view would waste its texels: six faces serve it better.
inline constexpr float kWidestSpotView = radians(75.0f);

/// Of a spot that shines from `eye` along `axis` (unit) within `half_angle` [rad]. The map's rows
/// run along `right` if that is across the axis: where light grazes a wall, edges beside it have no
/// steps.
[[nodiscard]] ShadowView make_spot_view(
    const Vec3& eye, const Vec3& axis, float half_angle, float near, int resolution, int guard,
    const Vec3& right = {0, 0, 0});

/// Face 0 .. 5 looks along +x, -x, +y, -y, +z, -z.
[[nodiscard]] ShadowView
make_cube_view(const Vec3& eye, int face, float near, int resolution, int guard);

inline constexpr int kMaxCascades = 4;

/// Where each cascade ends [m along the camera's axis], between `near` and `far`: midway from equal
/// ratios to equal steps, nearer to the former (Zhang et al. 2006).
[[nodiscard]] std::array<float, kMaxCascades> split_cascades(float near, float far, int count);

/// A sun's map of what the camera sees between two distances. The map is a square about the ball
/// around that slice, moves in whole texels and keeps its size, so that the texels stay where they
/// are on the ground when the camera moves or turns.
[[nodiscard]] ShadowView make_cascade_view(
    const RenderView& camera, const Vec3& to_sun, float slice_near, float slice_far, int resolution,
    int guard);

/// Planes around what may shade the slice of the camera's view between two distances, `margin` [m]
/// farther out: the slice, drawn out toward the sun, is bounded by planes through those of its
/// edges that are its outline as the sun sees it.
[[nodiscard]] Frustum shading_planes(
    const RenderView& camera, const Vec3& to_sun, double slice_near, double slice_far,
    double margin);

/// Area [texels] of the map under a pixel of the camera's picture that shows a surface with
/// `normal` at `point` (shadow.map-aliasing). Below 1 the map's texels show, above it some are
/// passed over.
[[nodiscard]] double texels_per_pixel(
    const ShadowView& view, const RenderView& camera, const Vec3& point, const Vec3& normal);

/// What lib/shadow.glsl reads of a view that lies at `place` of the atlas.
///   filter       ShadowFilter as a number
///   source_size  [m] or [rad]
///   bias         Shadow::bias
[[nodiscard]] layout::ShadowViewRecord make_shadow_record(
    const ShadowView& view, const AtlasRect& place, float filter, float source_size, float bias);

}  // namespace limn
