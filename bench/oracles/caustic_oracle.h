#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <vector>

namespace limn::oracle {

// Light under waves, photon by photon in double precision: each enters at a place of the surface at
// rest, is bent by Snell's law at the surface as it is there, weakened by Fresnel's equations, and
// goes straight on to the first thing it meets; or is mirrored there and goes up. What the caustic
// maps are held against.

/// The surface above a place at rest.
struct CausticSurface {
    glm::dvec3 position{0};
    glm::dvec3 area{0, 1, 0};  ///< of a square meter at rest [m^2], up
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
    std::vector<CausticBox> boxes;  ///< stand in it
};

struct CausticLight {
    int side = 0;               ///< cells of the floor along x and z
    std::vector<double> floor;  ///< light on each, over that of flat water without anything in it
    double entered = 0;         ///< all light, over that of flat water on a square meter [m^2]
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

/// `photons` of them, evenly spread with a little chance; `to_sun` is unit.
[[nodiscard]] CausticLight trace_photons(
    const CausticPool& pool, const CausticSurfaceAt& surface, const glm::dvec3& to_sun, int side,
    long photons);

/// The same of light that the surface mirrors, on a ceiling at `height` above rest: `floor` is the
/// part of it of half extents `half` about `middle`, `on_floor` all of it. Light that is thrown
/// down again has not entered.
[[nodiscard]] CausticLight trace_mirrored_photons(
    const CausticPool& pool, const CausticSurfaceAt& surface, const glm::dvec3& to_sun,
    double height, const glm::dvec2& middle, int side, long photons);

}  // namespace limn::oracle
