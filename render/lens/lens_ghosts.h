#pragma once

#include "ecs/base/math.h"

#include <span>
#include <vector>

namespace limn {

// Ghosts of a photographic lens (engine.lens-flare): light that two of its surfaces reflect before
// it arrives at the sensor.
//
// Paraxial rays have a height y and a slope u, which every event transforms linearly:
//
//     (y, u) <- [1 d; 0 1] (y, u)                 over the distance d
//               [1 0; (n/n' - 1)/R  n/n'] (y, u)  refracted from index n to n' at radius R
//               [1 0; 2/R 1] (y, u)               reflected
//
// with R > 0 where the center of curvature lies ahead. The product of the matrices of a path is its
// ray transfer (ABCD) matrix, whose first row gives the height at which a ray crosses a plane. Each
// pair of surfaces is a path: a ghost, and an image of the aperture stop whose position and size
// follow from the rows for the stop and the sensor. After Hullin et al., "Physically-Based
// Real-Time Lens Flare Rendering", 2011, and Lee and Eisemann, "Practical Real-Time Lens-Flare
// Rendering", 2013.
//
// Left out: dispersion, aberrations (ghosts of strongly tilted light are bent and have
// caustics), paths of more than two reflections, rims other than that of the front surface.

/// A spherical surface; listed in the order in which light crosses them.
struct LensSurface {
    double radius = 0;     ///< of curvature [mm], > 0: convex toward the front; 0: the aperture
    double thickness = 0;  ///< distance to the next surface [mm]
    double index = 1;      ///< of refraction behind it
    double diameter = 0;   ///< [mm]
};

/// A double Gauss of 50 mm, f/2: Tronnier, US patent 2,673,491, as scaled in Smith, "Modern Lens
/// Design", 1992, p. 312. The last thickness is unused: the sensor is in the focus.
[[nodiscard]] std::span<const LensSurface> double_gauss();

/// y = height * (y at the front surface) + slope * (slope at the front surface).
struct ParaxialMap {
    double height = 1;
    double slope = 0;
};

/// The direct path of light from infinity.
struct LensFocus {
    double focal_length = 0;    ///< [mm]
    double image_distance = 0;  ///< from the last surface to the sensor [mm]
    ParaxialMap stop;
};

[[nodiscard]] LensFocus focus_of(std::span<const LensSurface> lens);

/// A path that is reflected at surface `far`, then at surface `near` < `far`.
struct LensGhost {
    int near = 0;
    int far = 0;
    ParaxialMap sensor = {};
    ParaxialMap stop[3] = {};  ///< at each of its passages
    int passages = 0;
    Vec3 strength = {0, 0, 0};  ///< transmittance relative to the direct path
};

/// Anti-reflective coatings, a quarter wave of magnesium fluoride on each surface between glass and
/// air. Cemented surfaces have none.
struct LensCoating {
    double wavelength = 550;  ///< at which they are optimal [nm]; 0: no coating
    double spread = 0;        ///< largest difference from that; varies per surface [nm]
};

/// The ghosts of all pairs of surfaces.
[[nodiscard]] std::vector<LensGhost>
make_lens_ghosts(std::span<const LensSurface> lens, const LensCoating& coating);

/// Reflectance at normal incidence of a surface between the indices `n0` and `n2` for light of
/// `wavelength`, with a layer of index `n1` that is a quarter of `made_for` thick (both in nm; 0:
/// no layer). Exact for a layer without absorption (Born and Wolf, 1.6.4).
[[nodiscard]] double
coated_reflectance(double n0, double n1, double n2, double made_for, double wavelength);

}  // namespace limn
