#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Beside a MeshInstance: streaks behind it while it moves fast, as animators draw them.
struct SpeedLines {
    int count = 40;                ///< points of the mesh that may have one, 0 .. 4096
    float length_scale = 0.06f;    ///< a line is as long as the way of this time [s], >= 0
    float min_speed = 3.0f;        ///< slower points have none [m/s], >= 0
    float width = 0.003f;          ///< at the mesh, as a share of the picture's height
    Vec4 color = {1, 1, 1, 0.7f};  ///< linear, at the mesh; fades toward the tail
};

template <typename Visitor>
void visit_fields(SpeedLines& lines, Visitor&& visit) {
    visit("count", lines.count, {.doc = "points that may have one", .min = 0, .max = 4096});
    visit(
        "length_scale", lines.length_scale,
        {.doc = "a line is as long as the way of this time", .unit = "s", .min = 0, .max = 10});
    visit(
        "min_speed", lines.min_speed,
        {.doc = "slower points have no line", .unit = "m/s", .min = 0, .max = 1e4});
    visit(
        "width", lines.width,
        {.doc = "at the mesh, as a share of the picture's height", .min = 0, .max = 0.1});
    visit("color", lines.color, {.doc = "linear, with opacity; fades toward the tail"});
}

}  // namespace limn
