#pragma once

#include "ecs/base/gravity.h"

#include <cmath>
#include <limits>

namespace limn {

// Dispersion relation of waves of small height on water of depth h (Airy 1845):
//
//     omega^2 = g k tanh(k h)
//
// Wave number k = 2 pi / length [rad/m], frequency omega = 2 pi / period [rad/s]. Deeper than half
// a wavelength, omega^2 = g k, and long waves are fastest. In very shallow water, all waves have
// the speed sqrt(g h). No surface tension: ripples shorter than 2 cm are too slow. On land (h <= 0)
// frequency and speeds are 0, and the wave number is infinite.
// Techniques: water.shallow-refraction, water.travelling-wave

/// omega for k >= 0 [rad/s]. The depth may be infinite.
[[nodiscard]] inline double wave_frequency(double k, double depth) {
    return k > 0 && depth > 0 ? std::sqrt(kGravity * k * std::tanh(k * depth)) : 0.0;
}

/// k for omega >= 0 [rad/m], accurate to a few units in the last place.
[[nodiscard]] inline double wave_number(double omega, double depth) {
    if (!(omega > 0)) {
        return 0.0;
    }
    if (!(depth > 0)) {
        return std::numeric_limits<double>::infinity();
    }
    // Newton's method for x tanh x = y, with x = k h. The initial value (Eckart 1952) is within 5
    // %; three steps would suffice.
    const double deep = omega * omega / kGravity;
    const double y = deep * depth;
    if (y > 20) {
        return deep;  // 1 - tanh y is below double precision
    }
    double x = y / std::sqrt(std::tanh(y));
    for (int i = 0; i < 4; ++i) {
        const double t = std::tanh(x);
        x -= (x * t - y) / (t + x * (1.0 - t * t));
    }
    return x / depth;
}

/// Phase speed omega / k [m/s]: 0 for infinite k, largest for k = 0.
[[nodiscard]] inline double phase_speed(double k, double depth) {
    if (!(depth > 0)) {
        return 0.0;
    }
    return k > 0 ? wave_frequency(k, depth) / k : std::sqrt(kGravity * depth);
}

/// Group speed d omega / d k [m/s]: half the phase speed in deep water, equal in shallow water.
[[nodiscard]] inline double group_speed(double k, double depth) {
    const double x = k * depth;
    // 2 x / sinh 2 x is 1 at 0, and vanishes before sinh overflows.
    const double shallow = !(x > 0) ? 1.0 : x < 300 ? 2.0 * x / std::sinh(2.0 * x) : 0.0;
    return 0.5 * phase_speed(k, depth) * (1.0 + shallow);
}

}  // namespace limn
