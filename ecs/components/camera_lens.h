#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

/// How light that is out of focus is spread.
enum class FocusMethod : std::uint8_t {
    Gather,  ///< near and far apart, with discs in the shape of the aperture
    Mip,     ///< every pixel from the mip level as coarse as its own circle (post.dof-mip)
};

/// A thin lens in front of the Camera beside it, which keeps its field of view: its focal length
/// follows from that, from the sensor and from the focus (render/thin_lens.h). Without one, the
/// camera is a pinhole and all is sharp.
struct Lens {
    float f_number = 2.8f;         ///< focal length / diameter of the aperture, > 0
    float focus_distance = 3.0f;   ///< from the camera, along its axis [m], > 0
    float sensor_height = 0.024f;  ///< [m], > 0
    int blades = 0;                ///< sides of the aperture, 3 or more; less: it is round
    float blade_rotation = 0.0f;   ///< of its first corner, from the right to the top [rad]
    float largest_blur = 0.1f;  ///< widest disc that Gather and Mip draw, of the picture's height
    FocusMethod method = FocusMethod::Gather;
};

/// Keeps the Lens beside it focused on an entity.
struct Autofocus {
    Entity target{};          ///< null or gone: the focus stays where it is
    Vec3 offset = {0, 0, 0};  ///< of the point that is to be sharp, in the target's space [m]
    float response = 0.2f;    ///< time in which 63 % of the way is gone [s], >= 0; 0 = at once
    bool active = true;       ///< turned off by a hand on the ring (Input::lens)
};

template <typename Visitor>
void visit_fields(Lens& lens, Visitor&& visit) {
    visit(
        "f_number", lens.f_number,
        {.doc = "focal length / diameter of the aperture", .min = 0.01, .max = 1e6});
    visit(
        "focus_distance", lens.focus_distance,
        {.doc = "what is sharp, along the view axis", .unit = "m", .min = 1e-3, .max = 1e6});
    visit(
        "sensor_height", lens.sensor_height,
        {.doc = "height of the film", .unit = "m", .min = 1e-4, .max = 10});
    visit(
        "blades", lens.blades,
        {.doc = "sides of the aperture; less than 3: it is round", .min = 0, .max = 16});
    visit(
        "blade_rotation", lens.blade_rotation,
        {.doc = "of the first corner, from the right to the top", .unit = "rad"});
    visit(
        "largest_blur", lens.largest_blur,
        {.doc = "widest disc drawn, of the picture's height", .min = 0, .max = 0.25});
    visit(
        "method", lens.method,
        {.doc = "how light that is out of focus is spread", .values = "gather mip"});
}

template <typename Visitor>
void visit_fields(Autofocus& autofocus, Visitor&& visit) {
    visit("target", autofocus.target, {.doc = "entity that is to be sharp, by name"});
    visit("offset", autofocus.offset, {.doc = "of the point, in the target's space", .unit = "m"});
    visit(
        "response", autofocus.response,
        {.doc = "time in which 63 % of the way is gone; 0 = at once",
         .unit = "s",
         .min = 0,
         .max = 60});
    visit("active", autofocus.active, {.doc = "turned off by whoever pulls focus by hand"});
}

}  // namespace limn
