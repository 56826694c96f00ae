#pragma once

#include "ecs/base/math.h"

namespace limn {

// What a picture is the mean of (post.distributed-sampling, after R. Cook, T. Porter and
// L. Carpenter, "Distributed Ray Tracing", 1984): moments while the shutter is open, places on the
// lens, places in the pixel.

struct ExposureSample {
    double moment = 0;         ///< of the time that the shutter is open, -0.5 .. 0.5
    Vec2 jitter = {0, 0};      ///< place in the pixel [px], -0.5 .. 0.5
    Vec2 square = {0.5, 0.5};  ///< place on the lens, for point_on_aperture()
};

/// Sample `index` of `count`, in order of time: moments are strata of equal length, the other four
/// numbers a scrambled Sobol sequence, so that every part of the time sees pixel and lens evenly.
/// One sample alone is in the middle of all.
[[nodiscard]] ExposureSample exposure_sample(int index, int count);

}  // namespace limn
