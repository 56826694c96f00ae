#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: post.circle-of-confusion

/// How the depth-of-field blur is computed.
enum class FocusMethod : std::uint8_t {
    Gather,  ///< gathers near and far fields separately, with aperture-shaped kernels
    Mip,     ///< samples the mip level that matches each pixel's circle of confusion (post.dof-mip)
};

/// Thin lens of the Camera on the same entity. The camera keeps its field of view; the focal length
/// follows from it, the sensor height and the focus distance (render/lens/thin_lens.h). Without a
/// Lens, the camera is a pinhole and everything is in focus.
struct Lens {
    float f_number = 2.8f;
    float focus_distance = 3.0f;
    float sensor_height = 0.024f;
    int blades = 0;
    float blade_rotation = 0.0f;
    float max_blur = 0.1f;
    FocusMethod method = FocusMethod::Gather;
};

LIMN_FIELDS(Lens) {
    LIMN_FIELD(f_number, "focal length / aperture diameter", "", 0.01, 1e6);
    LIMN_FIELD(focus_distance, "distance of the focal plane along the view axis", "m", 1e-3, 1e6);
    LIMN_FIELD(sensor_height, "sensor height", "m", 1e-4, 10);
    LIMN_FIELD(blades, "number of aperture blades; fewer than 3: round", "", 0, 16);
    LIMN_FIELD(blade_rotation, "angle of the first aperture corner, from right toward up", "rad");
    LIMN_FIELD(
        max_blur, .doc = "largest blur diameter, as a fraction of the image height", .min = 0,
        .max = 0.25, .renamed = "largest_blur");
    LIMN_FIELD(method, .doc = "how the depth-of-field blur is computed", .values = "gather mip");
}

/// Keeps the Lens on the same entity focused on `target`.
struct Autofocus {
    Entity target{};  ///< if null or destroyed, the focus distance stays
    Vec3 offset = {0, 0, 0};
    float response = 0.2f;
    bool active = true;
};

LIMN_FIELDS(Autofocus) {
    LIMN_FIELD(target, "entity to focus on, by name");
    LIMN_FIELD(offset, "offset of the point in focus, in the target's space", "m");
    LIMN_FIELD(
        response, "time constant: 63 % of the change after this time; 0 = immediate", "s", 0, 60);
    LIMN_FIELD(active, "cleared by manual focusing");
}

}  // namespace limn
