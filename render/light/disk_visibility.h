#pragma once

#include "ecs/base/math.h"

namespace limn {

/// What disk_visibility.frag finds the share in sight of a disk in the image from: one texel.
struct DiskSource {
    Vec2 uv = {0, 0};
    float depth = 0;   ///< what has a greater one is before it
    float radius = 0;  ///< [px]
};

}  // namespace limn
