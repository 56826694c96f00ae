#pragma once

#include <glm/vec3.hpp>

#include <array>

namespace limn::oracle {

// A strand of hair as a rough dielectric cylinder with tilted scales, in double precision: Chiang
// et al., "A Practical and Controllable Hair and Fur Model for Production Path Tracing" (2016),
// integrated over the width of the strand, with the exact Fresnel term.

using DVec3 = glm::dvec3;

struct HairFiber {
    DVec3 color = DVec3(1);         ///< of many such strands together
    double roughness = 0.3;         ///< along the strand, 0 .. 1
    double roughness_across = 0.3;  ///< around it, 0 .. 1
    double tilt = 0;                ///< of the scales [rad]
};

/// Radiance of R, TT, TRT and all longer paths, for an irradiance of 1 on a plane that faces the
/// light. Inclinations are from the plane across the strand to its tip, `azimuth` is the angle
/// between light and viewer around it [rad].
[[nodiscard]] std::array<DVec3, 4> fiber_light(
    const HairFiber& fiber, double to_light, double to_viewer, double azimuth, int steps = 200);

}  // namespace limn::oracle
