#pragma once

#include "render/shadow/shadow_view.h"

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/ext/vector_double4.hpp>

#include <array>
#include <optional>
#include <span>

namespace limn {

// Perspective shadow maps (shadow.perspective-map): one map of the scene as a camera distorts it,
// where what is near is large, so that its shadows get more texels.
//
// A camera's matrix C takes the world to a cube, a light at l to C l: a place, or a direction if
// its w is 0. From there a second view sees the cube; the map's matrix is the product of both.
// Where the w of C l is negative, the light being behind the camera, what is nearer to the light
// is farther from C l, and depths turn about.
//
// C is not the camera itself but a virtual one behind it. The book moves that back until it sees
// all casters; here none is lost, since along a ray of the light depth grows as w / q, which has no
// gap where a caster passes the camera's plane, and what lies before the map's near end is drawn on
// it. Moving back only tempers the distortion: at first to the square root of near and far
// (Wimmer et al. 2004), farther while the light would see the cube too widely, in the limit to
// the uniform map. A light among what the camera sees has no such view.
//
// The map follows the camera, so its texels swim when that moves, and it is drawn anew.
// After Stamminger and Drettakis, "Perspective Shadow Maps", 2002; Kozlov, "Perspective Shadow
// Maps: Care and Feeding", 2004.

/// The part of what a camera sees that is to have shadows: between two distances along its axis
/// [m], and two slopes to the right and up.
struct ViewSlice {
    double near = 0.1;
    double far = 40;
    Vec2 low = {-1, -1};
    Vec2 high = {1, 1};
};
[[nodiscard]] std::array<glm::dvec3, 8>
slice_corners(const RenderView& camera, const ViewSlice& slice);

/// C of a camera that stands `shift` [m] behind `camera` and sees from `near` to `far` of it.
/// Depths are -1 .. 1, as the book has them, and w is the distance along its axis.
[[nodiscard]] glm::dmat4
virtual_camera(const RenderView& camera, double near, double far, double shift);

/// The view of a light on receivers (w of `distorted_from_world` > 0) in distorted space:
/// clip_from_world, with the reversed depth of all shadow views. None if the light is among them,
/// or they lie more than 60 degrees off its axis.
///   light     homogeneous: a place and 1, or the direction toward it and 0
///   widening  of the view beyond the receivers
[[nodiscard]] std::optional<glm::dmat4> fit_light_view(
    const glm::dmat4& distorted_from_world, const glm::dvec4& light,
    std::span<const glm::dvec3> receivers, double widening);

/// With the least distortion that the light allows; none: another kind of map must serve it.
[[nodiscard]] std::optional<ShadowView> make_perspective_view(
    const RenderView& camera, const Vec4& light, const ViewSlice& slice, int resolution, int guard);

}  // namespace limn
