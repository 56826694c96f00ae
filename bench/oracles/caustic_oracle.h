#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <vector>

namespace limn::oracle {

// Light under waves by photon tracing in double precision, the reference for the caustic maps: each
// photon enters at a point of the rest surface, is refracted at the displaced surface there by
// Snell's law, weighted by the Fresnel equations, and travels to the first hit; or it is reflected
// upward.

/// The displaced surface at a point at rest.
struct CausticSurface {
    glm::dvec3 position{0};
    glm::dvec3 area{0, 1, 0};  ///< area vector of a square meter at rest, upward [m^2]
};
using CausticSurfaceAt = std::function<CausticSurface(const glm::dvec2& rest)>;

struct CausticBox {
    glm::dvec3 low{0};
    glm::dvec3 high{0};
};

/// A pool of half extents `half` about the origin, its surface at rest at y = 0.
struct CausticPool {
    glm::dvec2 half{1};
    double depth = 1;
    double index = 1.333;
    std::vector<CausticBox> boxes;  ///< obstacles in it
};

struct CausticLight {
    int side = 0;               ///< number of floor cells along x and z
    std::vector<double> floor;  ///< irradiance of each cell, relative to flat, empty water
    double entered = 0;  ///< flux / irradiance under flat, empty water [m^2]; so the next three
    double on_floor = 0;
    double on_walls = 0;
    double on_boxes = 0;

    [[nodiscard]] double received() const { return on_floor + on_walls + on_boxes; }
    [[nodiscard]] double at(int x, int z) const {
        return floor
            [static_cast<std::size_t>(z) * static_cast<std::size_t>(side)
             + static_cast<std::size_t>(x)];
    }
};

/// Traces `photons` photons, stratified and jittered over the surface; `to_sun` is unit.
[[nodiscard]] CausticLight trace_photons(
    const CausticPool& pool, const CausticSurfaceAt& surface, const glm::dvec3& to_sun, int side,
    long photons);

/// The same for light that the surface reflects onto a ceiling at `height` above rest: `floor` is
/// the part of the ceiling with half extents `half` about `center`, `on_floor` is all of it.
/// Photons reflected downward do not count as entered.
[[nodiscard]] CausticLight trace_mirrored_photons(
    const CausticPool& pool, const CausticSurfaceAt& surface, const glm::dvec3& to_sun,
    double height, const glm::dvec2& center, int side, long photons);

}  // namespace limn::oracle
