#pragma once

#include "ecs/base/math.h"
#include "ecs/components/environment.h"

namespace limn {

// Maps a direction to a point (u, v) of a panorama in [0, 1]^2, v upward; the same as
// lib/panorama.glsl. Straight ahead (u = 1/2) is -z, to its right +x.
//
//   Equirectangular  longitude and latitude, the usual layout
//   Cylindrical      a strip of photographs, stitched while the camera turned about the vertical;
//                    its edge rows continue it above and below (env.panorama)
//   Angular          a disc: its center is straight up, the distance from it is the angle to that,
//                    its rim is straight down (env.angular-map)

[[nodiscard]] Vec2 equirectangular_uv(const Vec3& direction);

/// `half_angle` [rad]: from the horizon to the upper edge, in (0, pi/2).
[[nodiscard]] Vec2 cylindrical_uv(const Vec3& direction, float half_angle);

[[nodiscard]] Vec2 angular_uv(const Vec3& direction);

/// The mapping chosen by `mapping`.
[[nodiscard]] Vec2 panorama_uv(PanoramaMapping mapping, const Vec3& direction, float half_angle);

}  // namespace limn
