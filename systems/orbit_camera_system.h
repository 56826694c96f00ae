#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/characters/grounds.h"

#include <span>

namespace limn {

// The third-person camera: orbits a target, follows its position and orientation, and looks at it.
//
//     position += (wanted - position) (1 - (1 - follow)^(60 Hz * step))
//
// which does not depend on the step length; follow = 1 is rigid. Runs after update_transforms,
// because it needs the target's current matrix, and writes the camera's WorldTransform as well as
// its Transform. The camera must not have a Parent. Mouse and wheel rotate and zoom it while its
// Camera is active. After A. Watt, F. Policarpo, "Advanced Game Development with Programmable
// Graphics Hardware" (2005), chapter 11; the book's code covers factor * dt of the distance, which
// is never rigid (lag_position_legacy).

/// Where a camera that wants to be at `wanted` sees `point` without a mesh between them,
/// `clearance` before it [m]: rays to the camera and to the corners of a square about it.
[[nodiscard]] Vec3 clear_view(
    std::span<const PlacedGround> grounds, const Vec3& point, const Vec3& wanted, float clearance);

/// Moves every OrbitCamera. In the first frame and after a Teleport of camera or target it moves
/// rigidly and has no velocity. A null target is the world origin; if the target was destroyed, the
/// camera stays. One with a clearance looks over the people between it and its target and enters
/// none (systems/characters/view_bodies.h).
void update_orbit_cameras(
    Query<
        OrbitCamera, Transform, WorldTransform, PreviousWorldTransform, Optional<const Camera>,
        Without<Parent>>
        cameras,
    Query<const WorldTransform> bodies, Query<const WorldTransform, With<Teleport>> teleporting,
    Query<const Pose, const WorldTransform> characters, Res<const Input> input,
    Res<const FrameTime> time, GroundQueries grounds);

/// Direction on the unit sphere about the target: azimuth rotates from `ahead` toward `side`,
/// elevation raises it toward `above`.
struct OrbitDirection {
    float side;
    float ahead;
    float above;
};
[[nodiscard]] OrbitDirection orbit_direction(float azimuth, float elevation);

/// The book's convention, z up: local x is side, y ahead, z above. The scale of `target` does not
/// affect the distance.
[[nodiscard]] Vec3
orbit_position_z_up(const Affine& target, float azimuth, float elevation, float distance);
/// Our convention, y up: local x is side, z ahead, y above.
[[nodiscard]] Vec3
orbit_position(const Affine& target, float azimuth, float elevation, float distance);

/// Fraction of the distance covered in `dt` [s], 0 .. 1, if `follow` of it is covered in 1/60 s.
[[nodiscard]] float lag_fraction(float follow, float dt);
[[nodiscard]] Vec3 lag_position(const Vec3& position, const Vec3& wanted, float follow, float dt);
/// As printed in the book: position += (wanted - position) * factor * dt. Overshoots if factor * dt
/// > 1.
[[nodiscard]] Vec3
lag_position_legacy(const Vec3& position, const Vec3& wanted, float factor, float dt);

/// Orthonormal frame with columns x, y, z, whose z axis is `z` and whose y axis is closest to `up`.
/// For a camera, which looks along -z, pass the direction from the target. If z is parallel to
/// `up`, the most perpendicular coordinate axis replaces `up`; z of length 0 gives the identity.
[[nodiscard]] Mat3 look_at_frame(const Vec3& z, const Vec3& up);

}  // namespace limn
