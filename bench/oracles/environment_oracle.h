#pragma once

#include <glm/vec3.hpp>

#include <functional>

namespace limn::oracle {

// Environment lighting by summing over all directions in double precision. Slow and exact: no
// spherical harmonics, no importance sampling, no mip levels.

/// Radiance from a unit direction.
using RadianceFunction = std::function<glm::dvec3(const glm::dvec3&)>;

/// Irradiance / pi on a plane with this unit normal: the cosine-weighted mean over its hemisphere.
/// `steps` rings, four times as many sectors.
[[nodiscard]] glm::dvec3
irradiance(const RadianceFunction& radiance, const glm::dvec3& normal, int steps = 256);

/// The mean of radiance over the GGX lobe of a view along the normal, weighted by n.l (Karis 2013):
/// integral L(l) D(h) n.l dl / integral D(h) n.l dl with h halfway between n and l. Monte Carlo:
/// half vectors drawn from D with a fixed seed, one in each of `strata` x `strata` strata.
[[nodiscard]] glm::dvec3 prefiltered(
    const RadianceFunction& radiance, const glm::dvec3& normal, double roughness, int strata = 512);

}  // namespace limn::oracle
