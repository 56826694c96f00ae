#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::oracle {

// Transmittance of directional light through soft discs without an image, by the sum of their
// optical depths, which render/particles/particle_shadow_pass.h approximates by a series. A disc
// faces the light and is a slab as thick as its diameter.

struct ShadowDisc {
    glm::dvec3 center;   ///< [m]
    double diameter;     ///< [m], > 0
    double opacity = 1;  ///< of its center, 0 .. 1
};

/// Transmittance at `position` of light that travels along `axis` (unit).
[[nodiscard]] inline double disc_transmittance(
    const std::vector<ShadowDisc>& discs, const glm::dvec3& position, const glm::dvec3& axis) {
    double depth = 0;
    for (const ShadowDisc& disc : discs) {
        const glm::dvec3 to = position - disc.center;
        const double ahead = glm::dot(to, axis);
        const double r = 2 * glm::length(to - ahead * axis) / disc.diameter;
        const double inside = std::max(1 - r * r, 0.0);
        const double opacity = std::min(disc.opacity * inside * inside, 0.98);
        depth -= std::log(1 - opacity) * std::clamp(ahead / disc.diameter + 0.5, 0.0, 1.0);
    }
    return std::exp(-depth);
}

}  // namespace limn::oracle
