#pragma once

#include "ecs/base/math.h"

#include <vector>

namespace limn {

// The radiance of the daylight sky: sunlight that the air scatters (air.sky.lut). Once, it is
// summed along the rays of a table over elevation and azimuth from the sun; more often, it is
// assumed to arrive evenly from all sides, as a geometric series. Everything is on the CPU, in
// double precision, when the sun or the air changes: about 30 ms. Against a Monte Carlo reference:
// tests/render/atmosphere_test.cpp.
//
// Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", 2020.

struct AirSettings {
    float haze = 5;            ///< factor on Mie scattering
    Vec3 ground = Vec3(0.1f);  ///< albedo

    bool operator==(const AirSettings&) const = default;
};

/// What an air does to light, whatever the direction of the sun.
struct AirTables {
    static constexpr int kSines = 128;   ///< of transmittance
    static constexpr int kHeights = 64;  ///< of transmittance
    static constexpr int kScattered = 32;

    AirSettings settings;
    std::vector<glm::dvec3> transmittance;  ///< kHeights x kSines
    /// Mean radiance of light scattered at least twice, per irradiance of the sun: kScattered
    /// heights x as many sines of the sun's elevation.
    std::vector<glm::dvec3> scattered;
};

[[nodiscard]] AirTables make_air_tables(const AirSettings& settings);

/// The sky above a point on the ground, all per irradiance of the sun above the air [1/sr].
struct SkyView {
    static constexpr int kWidth = 96;   ///< azimuths: sin(angle from the sun / 2)
    static constexpr int kHeight = 96;  ///< square roots of sines of the elevation

    Vec3 sun = {0, 1, 0};        ///< toward it, unit
    Vec3 ground = {0, 0, 0};     ///< radiance of the ground
    std::vector<Vec4> radiance;  ///< kHeight x kWidth, from the horizon up; w unused
};

[[nodiscard]] SkyView make_sky_view(const AirTables& air, const Vec3& sun);

/// From `direction` (unit); the same as atmosphere_sky() of lib/sky.glsl.
[[nodiscard]] Vec3 sky_radiance(const SkyView& view, const Vec3& direction);

}  // namespace limn
