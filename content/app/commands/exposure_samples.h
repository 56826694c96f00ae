#pragma once

#include "ecs/base/math.h"

namespace limn {

// The samples that an accumulated image averages: times while the shutter is open, points on the
// lens and points in the pixel (post.distributed-sampling, after R. Cook, T. Porter and L.
// Carpenter, "Distributed Ray Tracing", 1984).

struct ExposureSample {
    double time = 0;           ///< from the center of the exposure, in exposure times, -0.5 .. 0.5
    Vec2 jitter = {0, 0};      ///< offset within the pixel [px], -0.5 .. 0.5
    Vec2 square = {0.5, 0.5};  ///< point on the lens, 0 .. 1, for point_on_aperture()
};

/// Sample `index` of `count`, in order of time: times are the midpoints of equal strata, the other
/// four coordinates a scrambled Sobol sequence, so that every part of the exposure covers pixel and
/// lens evenly. A single sample is at the center of everything.
[[nodiscard]] ExposureSample exposure_sample(int index, int count);

}  // namespace limn
