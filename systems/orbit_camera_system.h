#pragma once

#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// The third-person camera: circles a target, which it follows in place and orientation, and looks
// at it.
//
//     position += (wanted - position) (1 - (1 - follow)^(60 Hz * step))
//
// so that the same share of the way is left after the same time, whatever the step; follow = 1 is
// rigid. It runs after update_transforms, because it needs where the target is now, and writes its
// own WorldTransform besides its Transform. It has no Parent. Mouse and wheel turn and zoom it
// while its Camera is active. After A. Watt, F. Policarpo, "Advanced Game Development with
// Programmable Graphics Hardware" (2005), chapter 11; the book's code moves factor * dt of the way,
// which is never rigid (lag_position_legacy).

/// Moves every OrbitCamera. In the first frame and after a Teleport of camera or target it is rigid
/// and has no velocity. A null target is the world's origin; where the target is gone, the camera
/// stays.
void update_orbit_cameras(
    Query<
        OrbitCamera, Transform, WorldTransform, PreviousWorldTransform, Optional<const Camera>,
        Without<Parent>>
        cameras,
    Query<const WorldTransform> bodies, Query<const WorldTransform, With<Teleport>> jumping,
    Res<const Input> input, Res<const FrameTime> time);

/// Where on the unit sphere about the target: azimuth turns from `ahead` toward `side`, elevation
/// lifts toward `above`.
struct OrbitDirection {
    float side;
    float ahead;
    float above;
};
[[nodiscard]] OrbitDirection orbit_direction(float azimuth, float elevation);

/// The book's convention, z up: local x is the side, y ahead, z above. `target` may be scaled; the
/// distance is not.
[[nodiscard]] Vec3
orbit_position_z_up(const Affine& target, float azimuth, float elevation, float distance);
/// Ours, y up: local x is the side, z ahead, y above.
[[nodiscard]] Vec3
orbit_position(const Affine& target, float azimuth, float elevation, float distance);

/// Share of the way that is gone in `dt` [s], 0 .. 1, for a camera that goes `follow` of it in 1/60
/// s.
[[nodiscard]] float lag_share(float follow, float dt);
[[nodiscard]] Vec3 lag_position(const Vec3& position, const Vec3& wanted, float follow, float dt);
/// As the book prints it: position += (wanted - position) * factor * dt. Overshoots where factor *
/// dt > 1.
[[nodiscard]] Vec3
lag_position_legacy(const Vec3& position, const Vec3& wanted, float factor, float dt);

/// Columns x, y, z of a frame whose z axis is `z` and whose y axis leans toward `up`. For a camera,
/// which looks along -z, pass the direction from the target. Where z is parallel to `up`, the axis
/// most at right angles to z takes its place; z of length 0 gives the unit frame.
[[nodiscard]] Mat3 look_at_frame(const Vec3& z, const Vec3& up);

}  // namespace limn
