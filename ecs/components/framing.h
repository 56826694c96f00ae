#pragma once

#include "ecs/components/camera.h"
#include "ecs/reflect.h"

#include <cmath>

namespace limn {

/// Framing of a Camera that the program has placed around a subject.
struct FramingState {
    float aspect = 0.0f;
};

LIMN_FIELDS(FramingState) {
    LIMN_FIELD(
        aspect, "width over height of the narrowest image that shows all of the subject", "", 0,
        1e6);
}

/// `camera` for an image of `aspect` = width / height: in one that is too narrow for the subject,
/// the horizontal field of view stays and the vertical one grows.
[[nodiscard]] inline Camera
fit_camera(const Camera& camera, const FramingState& framing, float aspect) {
    Camera fitting = camera;
    if (aspect < framing.aspect) {
        fitting.fov_y = 2 * std::atan(std::tan(0.5f * camera.fov_y) * framing.aspect / aspect);
    }
    return fitting;
}

}  // namespace limn
