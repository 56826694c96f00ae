#pragma once

#include "ecs/base/math.h"
#include "ecs/components/animation.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"
#include "ecs/query.h"

#include <span>
#include <vector>

namespace limn {

// A camera that follows somebody among other people: it looks over those who would hide whom it
// follows, and enters nobody.
//
// A body is a ball about each of its joints, as they are posed. How much the camera rises depends
// on where people are in this step alone, and continuously so: it rises while somebody walks into
// the line of sight, and sinks as they leave it. Who stands so near that a steep view would be
// needed hides whom it follows.

/// Radius of a body about its joints, by eye [m].
inline constexpr float kBodyRadius = 0.16f;

/// The posed joints of a character, in the world.
using JointPlaces = std::vector<Vec3>;

/// Characters with something within `reach` of `point`, but for `except`, in world order.
[[nodiscard]] std::vector<JointPlaces> find_bodies(
    const Query<const Pose, const WorldTransform>& characters, Entity except, const Vec3& point,
    float reach);

/// Where a camera that wants to be at `wanted` sees `point` above the heads between them, as far
/// from it; `wanted` itself where nobody is.
[[nodiscard]] Vec3 look_over_bodies(
    std::span<const JointPlaces> bodies, const Vec3& point, const Vec3& wanted, float clearance);

/// The point nearest to `camera` on the way to `point` that is `clearance` off all bodies. Joints
/// that are so near to `point` do not count.
[[nodiscard]] Vec3 keep_off_bodies(
    std::span<const JointPlaces> bodies, const Vec3& point, const Vec3& camera, float clearance);

}  // namespace limn
