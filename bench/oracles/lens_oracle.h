#pragma once

namespace limn::oracle {

// A thin lens by its rays, in double precision: what comes from a point and passes the rim of the
// lens meets behind it, and where the film cuts that cone is the circle of confusion. Distances
// along the axis, in meters; nothing here is shared with render/thin_lens.h.

struct ThinLens {
    double focal_length = 0.05;
    double aperture = 0.025;  ///< diameter
    double focus = 2;         ///< distance of what the film shows sharp
};

/// Diameter on the film of the image of a point on the axis, `distance` in front of the lens. Found
/// by following the two rays through the rim.
[[nodiscard]] double image_diameter(const ThinLens& lens, double distance);

/// The lens of a camera with that field of view and film: the film is where it fills the view.
[[nodiscard]] ThinLens
lens_of_camera(double fov_y, double film_height, double f_number, double focus);

struct LensPoint {
    double x = 0;
    double y = 0;
};

/// Point `index` of `count` that fill the disc of radius 1 evenly: a sunflower.
[[nodiscard]] LensPoint lens_point(int index, int count);

}  // namespace limn::oracle
