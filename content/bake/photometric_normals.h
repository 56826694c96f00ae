#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <span>
#include <vector>

namespace limn {

// Normals of a matt surface from photographs in one light each, which the camera sees from the same
// place (face.photometric-normals; Woodham 1980; Rushmeier and Bernardini 1999). Of Lambert's law
//
//     radiance_i = g . light_i,    g = reflectance * normal
//
// g is the least-squares solution over the lights that reach the pixel, with three the exact one.
// Highlights break it, and so does light from elsewhere.

/// Fails where there are fewer than three lights, one has no length or is not finite, or all lie in
/// one plane. `to_light`: of any length; lights are equally bright.
[[nodiscard]] Status check_photometric_lights(std::span<const Vec3> to_light);

struct PhotometricPixel {
    Vec3 normal = {0, 0, 1};  ///< unit
    float reflectance = 0;    ///< times the brightness of the lights; 0: too few of them reach it
};

/// `to_light`: unit, as check_photometric_lights wants them. `radiance`: one for each light; those
/// that are not above `shadow` are left out.
[[nodiscard]] PhotometricPixel
solve_photometric(std::span<const Vec3> to_light, std::span<const float> radiance, float shadow);

}  // namespace limn
