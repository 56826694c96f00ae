#pragma once

#include "ecs/components/camera.h"
#include "ecs/components/camera_lens.h"
#include "ecs/components/input.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Manual lens controls: actions adjust focus, aperture and shutter. Focus distance and
// f-number change exponentially, the shutter angle linearly, so that each has a uniform rate on its
// scale. Manual focusing disables the lens's Autofocus.

/// Adjusts the lenses of active cameras, and the shutter of MotionBlur if there is one.
void adjust_lenses(
    Query<const Camera, Lens, Optional<Autofocus>> lenses, OptionalRes<MotionBlur> blur,
    Res<const Input> input, Res<const FrameTime> time);

/// Focus distance [m] after turning the ring for `dt` [s] at `turn`, -1 .. 1; > 0 toward infinity.
[[nodiscard]] float adjust_focus(float focus, float turn, float dt);
/// The f-number, likewise; > 0 opens the aperture.
[[nodiscard]] float adjust_aperture(float f_number, float turn, float dt);
/// The shutter angle [deg], likewise; > 0 lengthens the exposure.
[[nodiscard]] float adjust_shutter(float shutter, float turn, float dt);

}  // namespace limn
