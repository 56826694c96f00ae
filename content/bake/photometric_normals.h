#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <span>
#include <vector>

namespace limn {

// Photometric stereo: normals of a matte surface from photographs by a fixed camera, each in one
// light (face.photometric-normals; Woodham 1980; Rushmeier and Bernardini 1999). In Lambert's law
//
//     radiance_i = g . light_i,    g = reflectance * normal
//
// g is the least-squares solution over the lights that reach the pixel, exact with three of them.
// Highlights and ambient light violate the law.

/// Fails if there are fewer than three lights, one has no length or is not finite, or all are
/// coplanar. `to_light`: of any length; lights are equally bright.
[[nodiscard]] Status check_photometric_lights(std::span<const Vec3> to_light);

struct PhotometricPixel {
    Vec3 normal = {0, 0, 1};  ///< unit
    float reflectance = 0;    ///< times the brightness of the lights; 0: too few of them reach it
};

/// `to_light`: unit, accepted by check_photometric_lights. `radiance`: one per light; lights not
/// above `shadow` are ignored.
[[nodiscard]] PhotometricPixel
solve_photometric(std::span<const Vec3> to_light, std::span<const float> radiance, float shadow);

}  // namespace limn
