#pragma once

#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Moves every FlyCamera whose Camera is active (or that has none) by Input: the mouse rotates
/// about the parent's +y and tilts about the camera's local x axis, limited to just short of
/// vertical; `move` goes forward and sideways in view space and up along +y, five times as fast
/// with `fast`.
void update_fly_cameras(
    Query<const FlyCamera, Transform, Optional<const Camera>> cameras, Res<const Input> input,
    Res<const FrameTime> time);

/// One step of one camera. The length of `move` is clamped to 1.
void step_fly_camera(Transform& transform, const FlyCamera& fly, const MoveInput& input, float dt);

}  // namespace limn
