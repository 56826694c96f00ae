#pragma once

#include "ecs/base/math.h"

#include <span>
#include <vector>

namespace limn {

// Keys of a rotation that are gone through with one angular speed (anim.constant-angular-velocity):
// slerp() turns evenly from key to key, but faster where keys of equal times are farther apart.
// Here each interval gets time in proportion to its angle. Directions still break at the keys;
// squad() rounds those off.

struct TimedRotations {
    std::vector<Quat> rotations;  ///< aligned
    std::vector<float> times;     ///< [s], from 0, strictly increasing
};

/// The keys at such times that the last one is reached at `duration` > 0. A key that turns nothing
/// from the one before it would last no time, and is left out; at least the first is there.
[[nodiscard]] TimedRotations turn_evenly(std::span<const Quat> keys, float duration);

/// The same for a number of whole pictures >= 0: how many each of the intervals gets. They sum to
/// `frames`; those that lose most by rounding down get the ones that are left.
[[nodiscard]] std::vector<int> share_frames(std::span<const Quat> keys, int frames);

}  // namespace limn
