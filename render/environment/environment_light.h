#pragma once

#include "ecs/base/math.h"
#include "ecs/components/environment.h"
#include "render/environment/atmosphere.h"
#include "render/shaders/environment_gpu.h"

#include <vector>

namespace limn {

// Environment lighting: the sky function in C++ (the same as lib/sky.glsl), its projection onto
// nine spherical harmonics for diffuse surfaces, and the BRDF table that specular surfaces need
// besides the prefiltered reflection map. All of it changes only when the Environment does.
//
// Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001;
// Karis, "Real Shading in Unreal Engine 4", 2013.

/// The uniform block. `reflection` is filled by the pass that makes the maps.
[[nodiscard]] layout::EnvironmentBlock make_environment_block(
    const Environment& environment, const Vec3& sun_direction, const Vec3& sun_color);

/// Radiance of the sky from `direction` (unit), without the sun. Zero for a Panorama, which only
/// the GPU has. `view`: of an Atmosphere, black without it.
[[nodiscard]] Vec3 sky_radiance(
    const layout::EnvironmentBlock& block, const Vec3& direction, const SkyView* view = nullptr);

/// SH irradiance of the sky function; irradiance.comp does the same for cube maps.
[[nodiscard]] layout::Irradiance
project_irradiance(const layout::EnvironmentBlock& block, const SkyView* view = nullptr);

/// Irradiance / pi on a plane with the unit normal `normal`.
[[nodiscard]] Vec3 irradiance_toward(const layout::Irradiance& irradiance, const Vec3& normal);

/// The split-sum BRDF table: GGX reflects f0 * x + y of uniform surroundings; n.v runs along rows,
/// roughness down columns. `size` x `size` texels, the first and last standing for 0 and 1.
[[nodiscard]] std::vector<Vec2> make_specular_albedo(int size);

}  // namespace limn
