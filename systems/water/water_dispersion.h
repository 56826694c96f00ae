#pragma once

#include <cmath>
#include <limits>

namespace limn {

// How fast waves of small height run over water of depth h (Airy 1845):
//
//     omega^2 = g k tanh(k h)
//
// Wave number k = 2 pi / length [rad/m], frequency omega = 2 pi / period [rad/s]. Water deeper than
// half a wave is deep: omega^2 = g k, long waves are the fastest. Much shallower than a wave, all
// run with sqrt(g h). No surface tension: ripples shorter than 2 cm run too slowly.
// On land (h <= 0) nothing runs: frequency and speeds are 0, the wave number is infinite.

inline constexpr double kGravity = 9.81;  ///< [m/s^2]

/// omega of k >= 0 [rad/s]. An infinite depth is deep water, too.
[[nodiscard]] inline double wave_frequency(double k, double depth) {
    return k > 0 && depth > 0 ? std::sqrt(kGravity * k * std::tanh(k * depth)) : 0.0;
}

/// k of omega >= 0 [rad/m], to a few units in the last place.
[[nodiscard]] inline double wave_number(double omega, double depth) {
    if (!(omega > 0)) {
        return 0.0;
    }
    if (!(depth > 0)) {
        return std::numeric_limits<double>::infinity();
    }
    // Newton for x tanh x = y, with x = k h. The start (Eckart 1952) is within 5 %, three steps
    // would do.
    const double deep = omega * omega / kGravity;
    const double y = deep * depth;
    if (y > 20) {
        return deep;  // 1 - tanh y is below what a double can tell from 0
    }
    double x = y / std::sqrt(std::tanh(y));
    for (int i = 0; i < 4; ++i) {
        const double t = std::tanh(x);
        x -= (x * t - y) / (t + x * (1.0 - t * t));
    }
    return x / depth;
}

/// Of crests: omega / k [m/s]. Waves of length 0 stand, endless ones are the fastest.
[[nodiscard]] inline double phase_speed(double k, double depth) {
    if (!(depth > 0)) {
        return 0.0;
    }
    return k > 0 ? wave_frequency(k, depth) / k : std::sqrt(kGravity * depth);
}

/// Of the energy: d omega / d k [m/s]. Half the phase speed in deep water, all of it in shallow.
[[nodiscard]] inline double group_speed(double k, double depth) {
    const double x = k * depth;
    // 2 x / sinh 2 x is 1 at 0, and nothing before sinh overflows.
    const double shallow = !(x > 0) ? 1.0 : x < 300 ? 2.0 * x / std::sinh(2.0 * x) : 0.0;
    return 0.5 * phase_speed(k, depth) * (1.0 + shallow);
}

}  // namespace limn
