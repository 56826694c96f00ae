#pragma once

#include "ecs/base/math.h"
#include "render/geometry/culling.h"
#include "render/render_view.h"
#include "render/shaders/shadow_gpu.h"
#include "render/shadow/shadow_atlas.h"

#include <array>

namespace limn {

// Views that shadow maps are drawn from. A view maps the world to clip space with reversed depth:
// perspective (1 at the near plane, near / distance beyond) for a spot or a cube face, linear for a
// cascade of a sun. make_shadow_record() derives the projective matrix of shadow.projective-matrix,
// which maps the world to texels of the atlas.
//
// A border of `guard` texels around the covered region lets a filter sample without leaving the
// view: adjacent cube faces overlap by this border.

struct ShadowView {
    Mat4 clip_from_world{1.0f};
    Vec3 eye = {0, 0, 0};      ///< for a sun: center of its map
    float range = INFINITY;    ///< casters farther than this from the eye are ignored [m]
    int resolution = 512;      ///< side [texels], a power of two
    int guard = 2;             ///< [texels], < resolution / 2
    bool clamp_depth = false;  ///< casters in front of the near plane are clamped to it
    /// Penumbra width [texels] per depth difference of 1 and source size of 1 m (or 1 rad).
    float penumbra = 0;
    float detail = 0;               ///< Shadow::detail [texels]
    Frustum shading = kEverywhere;  ///< of a cascade: casters outside shade nothing visible
};

/// Half angle of a spot above which one view wastes texels and a cube map is used instead.
inline constexpr float kMaxSpotViewAngle = radians(75.0f);

/// View of a spot at `eye` along `axis` (unit) within `half_angle` [rad]. The map's rows run along
/// `right` if that is perpendicular to the axis, so that shadow edges on walls at grazing light
/// have no stair steps.
[[nodiscard]] ShadowView make_spot_view(
    const Vec3& eye, const Vec3& axis, float half_angle, float near, int resolution, int guard,
    const Vec3& right = {0, 0, 0});

/// Faces 0 .. 5 look along +x, -x, +y, -y, +z, -z.
[[nodiscard]] ShadowView
make_cube_view(const Vec3& eye, int face, float near, int resolution, int guard);

inline constexpr int kMaxCascades = 4;

/// The far end of each cascade [m along the camera's axis] between `near` and `far`: a blend of
/// logarithmic and uniform splits, nearer to the former (Zhang et al. 2006).
[[nodiscard]] std::array<float, kMaxCascades> split_cascades(float near, float far, int count);

/// A sun's map of a slice of the camera's view between two distances. The map is a square around
/// the slice's bounding sphere, of constant size and snapped to whole texels, so that the shadow
/// does not shimmer when the camera moves or turns.
[[nodiscard]] ShadowView make_cascade_view(
    const RenderView& camera, const Vec3& to_sun, float slice_near, float slice_far, int resolution,
    int guard);

/// Planes that bound the possible casters into the slice of the camera's view between two
/// distances, `margin` [m] farther out: the slice extruded toward the sun, bounded by planes
/// through the edges of its silhouette as viewed from the sun.
[[nodiscard]] Frustum shading_planes(
    const RenderView& camera, const Vec3& to_sun, double slice_near, double slice_far,
    double margin);

/// Area [texels] of the map under a pixel of the camera's image that shows a surface with `normal`
/// at `point` (shadow.map-aliasing). Below 1 the map is magnified, above it minified.
[[nodiscard]] double texels_per_pixel(
    const ShadowView& view, const RenderView& camera, const Vec3& point, const Vec3& normal);

/// Record for lib/shadow.glsl of a view drawn into `rect` of the atlas.
///   filter       ShadowFilter as a number
///   source_size  [m] or [rad]
///   bias         Shadow::bias
[[nodiscard]] layout::ShadowViewRecord make_shadow_record(
    const ShadowView& view, const AtlasRect& rect, float filter, float source_size, float bias);

}  // namespace limn
