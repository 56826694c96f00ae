#pragma once

#include "ecs/base/math.h"

namespace limn {

/// Input of disk_visibility.frag, which finds the visible fraction of a disk in the image: one
/// texel.
struct DiskSource {
    Vec2 uv = {0, 0};
    float depth = 0;   ///< surfaces of greater depth occlude it
    float radius = 0;  ///< [px]
};

}  // namespace limn
