#pragma once

#include "ecs/components/camera_lens.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Focus that follows an entity, as the motor of a lens does:
//
//     1/z += (1/z_target - 1/z) (1 - exp(-step / response)),    z along the view axis
//
// in 1/z, because circles of confusion are linear in it: all of the picture comes into focus at the
// same pace, near or far, and the same share of the way is left after the same time, whatever the
// step. It runs after everything that moves cameras, since it needs where they are now.

/// Focuses every Lens that has an active Autofocus. At once in the first frame and when camera or
/// target was teleported. Where the target is null, gone or not in front of the camera, the focus
/// stays.
void update_autofocus(
    Query<const Autofocus, Lens, const WorldTransform> cameras, Query<const WorldTransform> bodies,
    Query<const WorldTransform, With<Teleport>> jumping, Res<const FrameTime> time);

/// Focus after `dt` [s] of a lens focused at `focus` on its way to `wanted` [m], both > 0.
[[nodiscard]] float pull_focus(float focus, float wanted, float response, float dt);

}  // namespace limn
