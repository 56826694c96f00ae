#pragma once

#include "render/shadow/shadow_view.h"

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/ext/vector_double4.hpp>

#include <array>
#include <optional>
#include <span>

namespace limn {

// Perspective shadow maps (shadow.perspective-map): one map of the scene in the post-perspective
// space of a camera, where near objects are large, so that their shadows get more texels.
//
// A camera's matrix C maps the world to a cube, and a light at l to C l: a position, or a direction
// if its w is 0. From there a second view covers the cube; the map's matrix is the product of both.
// If the w of C l is negative, the light being behind the camera, the order of distances is
// inverted, and so are depths.
//
// C is not the camera itself but a virtual one behind it. The book moves it back until all casters
// are in view; here none is lost, since along a ray of the light depth grows as w / q, which is
// continuous where a caster crosses the camera's plane, and casters in front of the map's near
// plane are clamped to it. Moving back only reduces the distortion: initially to the square root of
// near and far (Wimmer et al. 2004), more if the light's view of the cube is too wide, in the limit
// to the uniform map. A light inside the camera's view volume has no such view.
//
// The map follows the camera, so it is redrawn and its texels swim when the camera moves. After
// Stamminger and Drettakis, "Perspective Shadow Maps", 2002; Kozlov, "Perspective Shadow Maps: Care
// and Feeding", 2004.

/// The part of a camera's view that receives shadows: between two distances along its axis [m], and
/// between two slopes to the right and up.
struct ViewSlice {
    double near = 0.1;
    double far = 40;
    Vec2 low = {-1, -1};
    Vec2 high = {1, 1};
};
[[nodiscard]] std::array<glm::dvec3, 8>
slice_corners(const RenderView& camera, const ViewSlice& slice);

/// C of a camera `shift` [m] behind `camera` that covers `near` to `far` of it. Depths are -1 .. 1,
/// as in the book, and w is the distance along its axis.
[[nodiscard]] glm::dmat4
virtual_camera(const RenderView& camera, double near, double far, double shift);

/// The view of a light onto receivers (w of `distorted_from_world` > 0) in distorted space:
/// clip_from_world, with the reversed depth of all shadow views. Nullopt if the light is among
/// them, or they lie more than 60 degrees off its axis.
///   light     homogeneous: (position, 1), or (direction toward it, 0)
///   widening  scale of the view beyond the receivers
[[nodiscard]] std::optional<glm::dmat4> fit_light_view(
    const glm::dmat4& distorted_from_world, const glm::dvec4& light,
    std::span<const glm::dvec3> receivers, double widening);

/// The view with the smallest usable camera shift; nullopt: use another kind of shadow map.
[[nodiscard]] std::optional<ShadowView> make_perspective_view(
    const RenderView& camera, const Vec4& light, const ViewSlice& slice, int resolution, int guard);

}  // namespace limn
