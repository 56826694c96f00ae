#pragma once

#include "ecs/base/math.h"

#include <span>

namespace limn {

// How far diffuse light travels under a surface: the normalized profile of Christensen and Burley,
// "Approximate Reflectance Profiles for Efficient Subsurface Scattering" (2015), and its quadrature
// by rings, one sample each, that render/shaders/subsurface.frag sums.

/// d of the profile [m], for red, green and blue, from the albedo and the mean free path of diffuse
/// light in the material [m]. The mean radius at which light exits is 2.5 d.
[[nodiscard]] Vec3 diffusion_distance(const Vec3& albedo, const Vec3& mean_free_path);

/// Weights of the sample density: the profiles of the widest, the middle and the narrowest channel;
/// they sum to 1.
struct DiffusionDensity {
    double widest, middle, narrowest;
    double center;  ///< fraction of the samples that the first ring stands for; 0: like the others
};
// Found by a search: these have the smallest error for skin at shadow edges of all angles. From
// afar the narrowest channels spread light over no more than a pixel, which needs few samples. From
// farther away the rings within a pixel are merged into one.
inline constexpr DiffusionDensity kDensityNear = {0.6, 0.2, 0.2, 0};
inline constexpr DiffusionDensity kDensityFar = {0.75, 0.15, 0.1, 0};
inline constexpr DiffusionDensity kDensityFarther = {0.75, 0.15, 0.1, 0.3};

/// Fraction of the light that exits within `radius`, 0 .. 1; 1 for d = 0.
[[nodiscard]] double diffused_within(double radius, double d);

/// Fills `samples` with rings around a point, from the inside out: x = radius of the sample [m],
/// yzw = integral of the profile over its ring for red, green and blue; each channel sums to 1.
/// Outer rings hold less light, and many rings sample each channel.
void sample_diffusion(const Vec3& d, const DiffusionDensity& density, std::span<Vec4> samples);

}  // namespace limn
