#pragma once

#include "ecs/base/math.h"

#include <cmath>

namespace limn {

// Height of a foot between two plants: up in the first third of its flight, down in the rest.
// After A. Watt, F. Policarpo, "Advanced Game Development with Programmable Graphics Hardware"
// (2005), chapter 9, figure 9.7.
// Techniques: char.foot-flight

/// y(x) for x from 0 to 3 pi: 0 at both ends, 2 at pi, with a slope of 0 there; the mean is 1.
[[nodiscard]] inline float flight_curve(float x) {
    return x <= kPi ? 1.0f - std::cos(x) : 1.0f - std::cos(0.5f * (kPi + x));
}

/// Height from lift-off (s = 0) to touchdown (1), 0 .. 2. `plateau` 0 .. 1: how level the foot is
/// held on its way down, at a third of its height, as recorded walkers do; 0: the curve itself.
[[nodiscard]] inline float flight_height(float s, float plateau = 0.0f) {
    const float height = flight_curve(3.0f * kPi * s);
    const float down = 1.5f * s - 0.5f;  // share of the way down
    if (plateau <= 0.0f || down <= 0.0f) {
        return height;
    }
    constexpr float kLevel = 0.66f;
    constexpr float kHalf = 0.55f;
    const float level =
        down < kHalf ? kLevel + (1.0f - 0.5f * kLevel) * (1.0f + std::cos(kPi * down / kHalf))
                     : 0.5f * kLevel * (1.0f + std::cos(kPi * (down - kHalf) / (1.0f - kHalf)));
    return height + plateau * (level - height);
}

}  // namespace limn
