#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

namespace limn::oracle {

// Light in and on skin in double precision: colors of pigments, a fitted BRDF, and the normalized
// diffusion profile with its consequences in closed form or by plain sums.

using DVec3 = glm::dvec3;

/// skin.melanin-blood: base - melanin am - blood ab, not clamped.
[[nodiscard]] DVec3 melanin_blood(double melanin, double blood);

/// skin.brdf-lafortune, one channel: D + sum max(0, Cx (ux vx + uy vy) + Cz uz vz)^n.
struct Lobe {
    double across = -1;
    double along = 1;
    double exponent = 1;
};
/// In a frame whose z axis is the normal; `u` toward the light, `v` toward the viewer, unit.
[[nodiscard]] double
lafortune(double diffuse, std::span<const Lobe> lobes, const DVec3& u, const DVec3& v);
/// Fraction of the light from `u` that such a surface reflects, where D is the albedo of its
/// diffuse part: (1 / pi) times the integral of f cos over the hemisphere.
[[nodiscard]] double
lafortune_albedo(double diffuse, std::span<const Lobe> lobes, const DVec3& u, int steps = 256);

/// The profile of Christensen and Burley (2015): light that exits per area at `r` [1/m^2].
[[nodiscard]] double diffusion_profile(double r, double d);
/// Its integral within r, 0 .. 1.
[[nodiscard]] double diffused_fraction(double r, double d);
/// d for an albedo and the mean free path of diffuse light ("searchlight" fit).
[[nodiscard]] double diffusion_scale(double albedo, double mean_free_path);
/// The same for red, green and blue.
[[nodiscard]] DVec3 diffusion_scales(const DVec3& albedo, const DVec3& mean_free_path);

/// Irradiance of a plane whose half x > 0 is lit by 1, once diffused, at `x`.
[[nodiscard]] double diffused_edge(double x, double d);
/// The same for a lit strip, |x| < width / 2.
[[nodiscard]] double diffused_strip(double x, double width, double d);
/// A parallelogram of a plane with uniform light, such as a pixel.
struct LitPatch {
    DVec3 center;
    DVec3 right;  ///< edges
    DVec3 up;
    double light = 0;
};
/// Diffused light at the center of patch `at`: the mean over all patches, weighted by the integral
/// of the profile over each.
[[nodiscard]] double diffused_patches(std::span<const LitPatch> patches, std::size_t at, double d);

/// Light transmitted by a slab whose back is lit by 1: the integral of the profile beyond
/// `thickness`.
[[nodiscard]] double transmitted(double thickness, double d);

}  // namespace limn::oracle
