#pragma once

#include "ecs/base/math.h"

#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

// Clear air around the Earth: what it scatters and absorbs of red, green and blue light, by height.
// Rayleigh scattering by molecules, Mie scattering by haze, absorption by ozone (air.sky.model).
// Heights and distances in km. Bruneton, "A Qualitative and Quantitative Evaluation of 8 Clear Sky
// Models", 2017; Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering
// Technique", 2020.

inline constexpr double kGroundRadius = 6360;  ///< [km]
inline constexpr double kAirRadius = 6460;     ///< where the air ends [km]

// Per km at the ground, heights in km; ozone lies about its height, half the width to each side.
inline constexpr glm::dvec3 kRayleighScattering = {0.005802, 0.013558, 0.033100};
inline constexpr glm::dvec3 kOzoneAbsorption = {0.000650, 0.001881, 0.000085};
inline constexpr double kMieScattering = 0.003996;
inline constexpr double kMieExtinction = 0.004440;
inline constexpr double kRayleighHeight = 8;
inline constexpr double kMieHeight = 1.2;
inline constexpr double kOzoneHeight = 25;
inline constexpr double kOzoneHalfWidth = 15;
inline constexpr int kAirSteps = 64;

/// Per km at one height.
struct AirSample {
    glm::dvec3 rayleigh;    ///< scattering
    double mie;             ///< scattering
    glm::dvec3 extinction;  ///< scattering and absorption
};

/// `height` above the ground [km]; `haze`: factor on Mie scattering, 1 = very clear air, 20 = a
/// summer day.
[[nodiscard]] inline AirSample sample_air(double height, double haze) {
    const double above = std::max(height, 0.0);
    const double mie = haze * std::exp(-above / kMieHeight);
    const glm::dvec3 rayleigh = kRayleighScattering * std::exp(-above / kRayleighHeight);
    const double ozone = std::max(0.0, 1 - std::abs(above - kOzoneHeight) / kOzoneHalfWidth);
    return {
        rayleigh, kMieScattering * mie, rayleigh + kOzoneAbsorption * ozone + kMieExtinction * mie};
}

/// Distance along a ray to the sphere of `radius` around the Earth's center, from inside the air;
/// < 0: it misses. `sine`: of the ray's elevation at the distance `from` from the center [km].
[[nodiscard]] inline double distance_to_shell(double from, double sine, double radius) {
    const double along = from * sine;
    const double discriminant = along * along - (from * from - radius * radius);
    if (discriminant < 0) {
        return -1;
    }
    const double root = std::sqrt(discriminant);
    return from > radius ? -along - root : -along + root;
}

/// The fraction of light that passes from space to the distance `from` from the center [km], coming
/// from an elevation of this sine; 0 if the Earth is in the way.
[[nodiscard]] inline glm::dvec3 air_transmittance(double from, double sine, double haze) {
    if (sine < 0 && from * std::sqrt(1 - sine * sine) < kGroundRadius) {
        return glm::dvec3(0);
    }
    const double length = distance_to_shell(from, sine, kAirRadius);
    glm::dvec3 depth(0);
    double begin = 0;
    for (int i = 1; i <= kAirSteps; ++i) {  // steps grow with the distance: the air thins out
        const double end = length * (i * i) / (kAirSteps * kAirSteps);
        const double t = 0.5 * (begin + end);
        const double radius = std::sqrt(from * from + t * t + 2 * from * t * sine);
        depth += sample_air(radius - kGroundRadius, haze).extinction * (end - begin);
        begin = end;
    }
    return glm::exp(-depth);
}

}  // namespace limn
