#pragma once

#include "ecs/base/math.h"

#include <span>
#include <vector>

namespace limn {

// Constant angular velocity through rotation keys (anim.constant-angular-velocity): slerp() has
// constant speed within an interval, but with equally spaced keys larger angles are faster. Here
// the duration of each interval is proportional to its angle. The axis still changes abruptly at
// the keys; squad() smooths that.

struct TimedRotations {
    std::vector<Quat> rotations;  ///< aligned
    std::vector<float> times;     ///< [s], from 0, strictly increasing
};

/// Assigns times to the keys, the last one at `duration` > 0. Keys equal to their predecessor,
/// whose interval would have length 0, are dropped; the first is kept.
[[nodiscard]] TimedRotations make_constant_speed(std::span<const Quat> keys, float duration);

/// The same in whole frames: number of frames >= 0 for each interval, with the sum `frames`
/// (largest remainder method).
[[nodiscard]] std::vector<int> distribute_frames(std::span<const Quat> keys, int frames);

}  // namespace limn
