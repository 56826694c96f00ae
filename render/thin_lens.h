#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/camera_lens.h"

namespace limn {

struct Camera;

// The optics of a camera with a thin lens (post.circle-of-confusion): of focal length F, aperture
// diameter A = F / n and focused at z_f, it images a point at distance z as a disc of diameter
//
//     d = F^2 / (n (z_f - F)) |z - z_f| / z = A v_f |1/z_f - 1/z|,    1/v_f = 1/F - 1/z_f
//
// on a film v_f behind it: linear in 1/z, hence in reversed depth. A source of the formula takes it
// for linear in |z - z_f|, which holds near the focus alone.
//
// A camera has a field of view and the film a height, so that v_f is what is given, and F follows
// from it and z_f. It gets shorter as the focus comes nearer, as in lenses that do not breathe, and
// is always less than z_f: every focus in front of the camera is a real one.

/// F [m] of the lens that fills `sensor_height` with `fov_y`, focused at `focus_distance`.
[[nodiscard]] double focal_length(double fov_y, double sensor_height, double focus_distance);

/// Diameter [m] of the image of a point at `distance` on the film, infinitely far ones included.
/// `focus_distance` > `focal_length`.
[[nodiscard]] double
circle_of_confusion(double focal_length, double f_number, double focus_distance, double distance);

/// What rendering needs of a Lens.
struct LensView {
    float aperture_radius = 0.0f;  ///< [m], of the circle through its corners; 0: a pinhole
    float focus_distance = 1.0f;   ///< [m], > 0
    int blades = 0;                ///< less than 3: round
    float blade_rotation = 0.0f;   ///< [rad]
    float largest_blur = 0.1f;     ///< diameter of the widest disc drawn, of the picture's height
    FocusMethod method = FocusMethod::Gather;
};

/// Fails with one line if the lens is none: an aperture or a film of size 0 or less, a focus that
/// is not in front of the camera. An infinite f-number is a pinhole, an infinite focus is a focus.
[[nodiscard]] Result<LensView> make_lens_view(const Lens& lens, const Camera& camera);

/// Diameter [px] of the image of a point at `distance`, negative in front of the focus:
/// circle_scale (1 / focus_distance - 1 / distance).
[[nodiscard]] float circle_scale(const LensView& lens, float tangent_y, int height);  // [px m]

/// From the unit square onto the aperture of radius 1, equal areas onto equal areas: the disc by
/// Shirley and Chiu's concentric map (1997), a polygon by its triangles.
[[nodiscard]] Vec2 point_on_aperture(const LensView& lens, const Vec2& square);

}  // namespace limn
