#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Techniques: water.fresnel-approx, water.reflection-refraction-maps, water.refraction-map,
//     water.whitecaps
// Source of water.whitecaps: Tessendorf, "Simulating ocean water", 2001

/// Fresnel reflectance of the surface seen from above (ecs/base/optics.h). From below, with total
/// internal reflection, it is always exact.
enum class WaterFresnel : std::uint8_t {
    Exact,    ///< the Fresnel equations
    Schlick,  ///< within 0.06 of exact
    Angle,    ///< after the book: constant up to 45 degrees, then a parabola; up to 0.27 too bright
};

/// Source of reflections, seen from above.
enum class WaterReflection : std::uint8_t {
    ScreenSpace,  ///< screen space, with the environment as fallback
    Environment,  ///< the environment only
    Planar,       ///< the scene rendered again by a camera mirrored at the rest surface
    Map,          ///< after the book: reflection_map on a plane above, lit by downwelling light
};

/// Source of refraction, seen from above.
enum class WaterRefraction : std::uint8_t {
    Traced,   ///< refracted rays traced in screen space
    Shifted,  ///< after the book: the scene image offset by the surface normal
    Floor,    ///< after the book: floor_map where refracted rays hit the bottom, lit from above
};

/// With a Water: alternatives to the default shading.
struct WaterLook {
    WaterFresnel fresnel = WaterFresnel::Exact;
    WaterReflection reflection = WaterReflection::ScreenSpace;
    WaterRefraction refraction = WaterRefraction::Traced;
    float distortion = 1;
    float map_scale = 0.5f;
    ImageId floor_map{};  ///< for Floor, where depth > 0; all waters share one
    float floor_tile = 2;
    ImageId reflection_map{};  ///< for Map; all waters share one
    float reflection_tile = 50;
    float reflection_height = 20;
    float foam_below = -1;
    float foam_decay = 1.5f;
};

LIMN_FIELDS(WaterLook) {
    LIMN_FIELD(
        fresnel, .doc = "Fresnel reflectance: exact, or an approximation",
        .values = "exact schlick angle");
    LIMN_FIELD(
        reflection,
        .doc =
            "source of reflections: screen space, environment, a mirrored camera, or an authored "
            "map of what is above",
        .values = "screen_space environment planar map", .renamed = "picture=screen_space");
    LIMN_FIELD(
        refraction, .doc = "source of refraction: screen-space rays, offset image, or floor map",
        .values = "traced shifted floor");
    LIMN_FIELD(distortion, "wave distortion of planar and shifted; 1: physical, 0: flat", "", 0, 4);
    LIMN_FIELD(
        map_scale, "resolution of planar as a fraction of the frame's, per side", "", 0.1, 1);
    LIMN_FIELD(floor_map, "color map of the bottom");
    LIMN_FIELD(floor_tile, "side length of a tile of the floor map", "m", 0.01, 1e4);
    LIMN_FIELD(reflection_map, "color map of what water reflects, on a level plane above it");
    LIMN_FIELD(reflection_tile, "side length of a tile of the reflection map", "m", 0.01, 1e5);
    LIMN_FIELD(reflection_height, "of its plane above the water", "m", 0.01, 1e5);
    LIMN_FIELD(
        foam_below,
        "whitecaps where the Jacobian of the displacement by closed-form waves is below this; -1: "
        "none. An ocean has its foam_threshold",
        "", -1, 1);
    LIMN_FIELD(foam_decay, "time constant of the decay of whitecaps to 1/e", "s", 0.01, 100);
}

}  // namespace limn
