#pragma once

namespace limn::oracle {

// A thin lens by ray tracing in double precision: rays from a point through the rim of the lens
// converge behind it, and the film's section of that cone is the circle of confusion. Distances
// along the axis, in meters. Shares no code with render/lens/thin_lens.h.

struct ThinLens {
    double focal_length = 0.05;
    double aperture = 0.025;  ///< diameter
    double focus = 2;         ///< distance of the plane in focus
};

/// Diameter on the film of the image of a point on the axis, `distance` in front of the lens. Found
/// by tracing the two rays through the rim.
[[nodiscard]] double image_diameter(const ThinLens& lens, double distance);

/// The lens of a camera with this vertical field of view [rad] and film height [m]; the film's
/// distance follows from both.
[[nodiscard]] ThinLens
lens_of_camera(double fov_y, double film_height, double f_number, double focus);

struct LensPoint {
    double x = 0;
    double y = 0;
};

/// Point `index` of `count` uniformly distributed over the unit disc (sunflower spiral).
[[nodiscard]] LensPoint lens_point(int index, int count);

}  // namespace limn::oracle
