#pragma once

#include "ecs/components/camera_lens.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Focus that tracks an entity, like the motor of a lens:
//
//     1/z += (1/z_target - 1/z) (1 - exp(-step / response)),    z along the view axis
//
// in 1/z, because circles of confusion are linear in it: the image comes into focus at the same
// rate at any distance, and the result does not depend on the step length. Runs after everything
// that moves cameras, since it needs their current matrices.

/// Focuses every Lens that has an active Autofocus; immediately in the first frame and when camera
/// or target was teleported. If the target is null, destroyed or not in front of the camera, the
/// focus distance stays.
void update_autofocus(
    Query<const Autofocus, Lens, const WorldTransform> cameras, Query<const WorldTransform> bodies,
    Query<const WorldTransform, With<Teleport>> teleporting, Res<const FrameTime> time);

/// Focus distance after `dt` [s], moving from `focus` toward `wanted` [m], both > 0.
[[nodiscard]] float pull_focus(float focus, float wanted, float response, float dt);

}  // namespace limn
