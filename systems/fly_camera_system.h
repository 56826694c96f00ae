#pragma once

#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Moves every FlyCamera whose Camera is active (or that has none) by the input: the mouse turns
/// about the parent's +y and tilts about the camera's own x axis, short of straight up and down;
/// keys move forward and sideways along the view and up along +y, five times as quick with
/// Input::fast.
void update_fly_cameras(
    Query<const FlyCamera, Transform, Optional<const Camera>> cameras, Res<const Input> input,
    Res<const FrameTime> time);

/// One step of one camera. `move` beyond length 1 counts as 1.
void step_fly_camera(Transform& transform, const FlyCamera& fly, const Input& input, float dt);

}  // namespace limn
