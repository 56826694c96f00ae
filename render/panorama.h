#pragma once

#include "ecs/base/math.h"
#include "ecs/components/environment.h"

namespace limn {

// Which point of one flat picture of all surroundings shows a direction: (u, v) in [0, 1]^2 with v
// upward, as lib/panorama.glsl has it. Straight ahead (u = 1/2) is -z, to its right +x.
//
//   Equirectangular  longitude and latitude: what panoramas are today
//   Cylindrical      a strip of photographs, stitched while the camera turned about the vertical;
//                    beyond its upper and lower edge it is continued by its last row (env.panorama)
//   Angular          a disc: its middle is straight up, the distance from it the angle to that, the
//                    rim straight down (env.angular-map)

[[nodiscard]] Vec2 equirectangular_uv(const Vec3& direction);

/// `half_angle` [rad]: from the horizon to the upper edge, 0 .. pi/2 exclusive.
[[nodiscard]] Vec2 cylindrical_uv(const Vec3& direction, float half_angle);

[[nodiscard]] Vec2 angular_uv(const Vec3& direction);

/// Any of them.
[[nodiscard]] Vec2 panorama_uv(PanoramaMapping mapping, const Vec3& direction, float half_angle);

}  // namespace limn
