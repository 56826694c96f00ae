#pragma once

#include "ecs/base/math.h"
#include "ecs/components/environment.h"
#include "render/shaders/environment_gpu.h"

#include <vector>

namespace limn {

// Light from the surroundings: the sky function in C++ (lib/sky.glsl says the same), its projection
// on nine spherical harmonics for diffuse surfaces, and the table that specular surfaces need
// beside the blurred reflection map. All of it changes only when the Environment does.
//
// Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001;
// Karis, "Real Shading in Unreal Engine 4", 2013.

/// The block that shaders read. `reflection` is left to the pass that makes the maps.
[[nodiscard]] layout::EnvironmentBlock make_environment_block(
    const Environment& environment, const Vec3& sun_direction, const Vec3& sun_color);

/// Radiance from `direction` (unit) that lights the scene; no sun. Of a Panorama, which is the
/// GPU's, nothing.
[[nodiscard]] Vec3 sky_radiance(const layout::EnvironmentBlock& block, const Vec3& direction);

/// The sky function's irradiance; irradiance.comp does the same for cube maps.
[[nodiscard]] layout::Irradiance project_irradiance(const layout::EnvironmentBlock& block);

/// Irradiance / pi on a plane with this unit normal.
[[nodiscard]] Vec3 irradiance_toward(const layout::Irradiance& irradiance, const Vec3& normal);

/// What GGX reflects of uniform surroundings is f0 * x + y; n.v runs along rows, roughness down.
/// `size` x `size` texels whose first and last stand for 0 and 1.
[[nodiscard]] std::vector<Vec2> make_specular_albedo(int size);

}  // namespace limn
