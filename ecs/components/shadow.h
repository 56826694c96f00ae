#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// How the shadows of a light are found (shadow.selection).
enum class ShadowMethod : std::uint8_t {
    Auto,         ///< volumes for a light with a ShadowVolume beside it, else maps
    Map,          ///< shadow maps: one view of a spot, six of a point light, cascades of a sun
    Perspective,  ///< one map of the scene as the camera's perspective distorts it; Map where the
                  ///< light is among what the camera sees
    Volume,       ///< stencil volumes: exact to the pixel, hard, closed meshes only
    Hybrid,       ///< a map, and volumes at its edges alone
};

/// How the edge of a map's shadow is drawn.
enum class ShadowFilter : std::uint8_t {
    Hard,              ///< one comparison: texels show
    Bilinear,          ///< 2x2 comparisons, weighted (shadow.pcf)
    Soft,              ///< sixteen of those (shadow.soft-pcf): as wide everywhere
    ContactHardening,  ///< as wide as the light's size makes it (shadow.penumbra); of Perspective:
                       ///< Soft
};

/// The light beside it casts shadows.
struct Shadow {
    ShadowMethod method = ShadowMethod::Auto;
    ShadowFilter filter = ShadowFilter::Bilinear;
    int resolution = 512;      ///< side of a map [texels], 16 .. 4096
    float source_size = 0.1f;  ///< diameter of what shines [m], of a sun its angle [rad]; >= 0
    int cascades = 3;          ///< maps of a sun, one behind the other, 1 .. 4
    float distance = 40.0f;    ///< up to where a sun casts shadows [m from the camera], > 0
    float bias = 1.0f;         ///< 1 needs no tuning; 0 shows why there is one
};

/// Tag: the mesh instance casts no shadow.
struct NoShadow {};

template <typename Visitor>
void visit_fields(Shadow& shadow, Visitor&& visit) {
    visit(
        "method", shadow.method,
        {.doc = "how its shadows are found", .values = "auto map perspective volume hybrid"});
    visit(
        "filter", shadow.filter,
        {.doc = "how the edge of a map's shadow is drawn",
         .values = "hard bilinear soft contact_hardening"});
    visit(
        "resolution", shadow.resolution,
        {.doc = "side of a map", .unit = "texels", .min = 16, .max = 4096});
    visit(
        "source_size", shadow.source_size,
        {.doc = "diameter of what shines; of a directional light an angle [rad]",
         .unit = "m",
         .min = 0,
         .max = 100});
    visit(
        "cascades", shadow.cascades,
        {.doc = "maps of a directional light, one behind the other", .min = 1, .max = 4});
    visit(
        "distance", shadow.distance,
        {.doc = "up to where a directional light casts shadows",
         .unit = "m",
         .min = 0.1,
         .max = 1e5});
    visit("bias", shadow.bias, {.doc = "1 needs no tuning; 0 shows why", .min = 0, .max = 8});
}

}  // namespace limn
