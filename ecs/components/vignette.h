#pragma once

#include "ecs/reflect.h"

namespace limn {

/// Resource: how the lens darkens toward the corners. None if absent or both are 0.
struct Vignette {
    float natural = 0.0f;
    float mechanical = 0.0f;

    bool operator==(const Vignette&) const = default;
};

LIMN_FIELDS(Vignette) {
    LIMN_FIELD(
        natural,
        "how much of the cos^4 law of an ideal lens; 1 = all, at the camera's field of view", "", 0,
        1);
    LIMN_FIELD(
        mechanical,
        "shift of the rim of the lens against the pupil in the corners, in pupil diameters", "", 0,
        1);
}

}  // namespace limn
