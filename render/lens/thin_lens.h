#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/camera_lens.h"

namespace limn {

struct Camera;

// The optics of a camera with a thin lens (post.circle-of-confusion). With focal length F, aperture
// diameter A = F / n and focus distance z_f, a point at distance z is imaged as a disc of diameter
//
//     d = F^2 / (n (z_f - F)) |z - z_f| / z = A v_f |1/z_f - 1/z|,    1/v_f = 1/F - 1/z_f
//
// on a film v_f behind the lens: linear in 1/z, hence in reversed depth. One source of the formula
// has it linear in |z - z_f|, which holds only near the focus.
//
// A camera gives the field of view and the film height, hence v_f; F follows from it and z_f. F
// gets shorter as the focus comes nearer, as in lenses without focus breathing, and is always less
// than z_f: every focus in front of the camera is valid.

/// F [m] of the lens that fills `sensor_height` with `fov_y`, focused at `focus_distance`.
[[nodiscard]] double focal_length(double fov_y, double sensor_height, double focus_distance);

/// Diameter [m] of the circle of confusion on the film of a point at `distance`, which may be
/// infinite. `focus_distance` > `focal_length`.
[[nodiscard]] double
circle_of_confusion(double focal_length, double f_number, double focus_distance, double distance);

/// A Lens as the renderer uses it.
struct LensView {
    float aperture_radius = 0.0f;  ///< [m], circumscribed circle of the polygon; 0: a pinhole
    float focus_distance = 1.0f;   ///< [m], > 0
    int blades = 0;                ///< fewer than 3: round
    float blade_rotation = 0.0f;   ///< [rad]
    float max_blur = 0.1f;         ///< maximum disc diameter, fraction of the image height
    FocusMethod method = FocusMethod::Gather;
};

/// Fails with a one-line message if the lens is invalid: an aperture or film of size 0 or less, or
/// a focus not in front of the camera. An infinite f-number is a pinhole; an infinite focus
/// distance is valid.
[[nodiscard]] Result<LensView> make_lens_view(const Lens& lens, const Camera& camera);

/// The scale in: circle of confusion [px] = scale (1 / focus_distance - 1 / distance), negative in
/// front of the focus.
[[nodiscard]] float circle_scale(const LensView& lens, float tangent_y, int height);  // [px m]

/// Area-preserving map from the unit square onto the aperture of radius 1: the disc by Shirley and
/// Chiu's concentric map (1997), a polygon by its triangles.
[[nodiscard]] Vec2 point_on_aperture(const LensView& lens, const Vec2& square);

}  // namespace limn
