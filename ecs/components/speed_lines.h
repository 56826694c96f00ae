#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// With a MeshInstance: cartoon speed lines behind it while it moves fast.
struct SpeedLines {
    int count = 40;
    float length_scale = 0.06f;
    float min_speed = 3.0f;
    float width = 0.003f;
    Vec4 color = {1, 1, 1, 0.7f};
};

LIMN_FIELDS(SpeedLines) {
    LIMN_FIELD(count, "number of points that can emit a line", "", 0, 4096);
    LIMN_FIELD(length_scale, "line length as travel time", "s", 0, 10);
    LIMN_FIELD(min_speed, "slower points have no line", "m/s", 0, 1e4);
    LIMN_FIELD(width, "width at the mesh, as a fraction of the image height", "", 0, 0.1);
    LIMN_FIELD(color, "linear RGB and opacity; fades toward the tail");
}

}  // namespace limn
