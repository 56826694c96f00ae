#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: shadow.selection

/// Shadowing technique of a light (shadow.selection).
enum class ShadowMethod : std::uint8_t {
    Auto,         ///< volumes if the light has a ShadowVolume, else maps
    Map,          ///< shadow maps: one for a spot light, six for a point light, cascades for a sun
    Perspective,  ///< one perspective shadow map (in post-projective space); Map where the light is
                  ///< inside the view
    Volume,       ///< stencil volumes: pixel-exact and hard, closed meshes only
    Hybrid,       ///< a map, with volumes only at shadow edges
};

/// Filtering of a shadow map.
enum class ShadowFilter : std::uint8_t {
    Hard,              ///< one comparison: texels are visible
    Bilinear,          ///< 2x2 weighted comparisons (shadow.pcf)
    Soft,              ///< sixteen bilinear taps (shadow.soft-pcf): constant penumbra width
    ContactHardening,  ///< penumbra width from the light's size (shadow.penumbra); with
                       ///< Perspective: Soft
};

/// Makes the light on the same entity cast shadows.
struct Shadow {
    ShadowMethod method = ShadowMethod::Auto;
    ShadowFilter filter = ShadowFilter::Bilinear;
    int resolution = 512;
    float source_size = 0.1f;
    int cascades = 3;
    float distance = 40.0f;
    float bias = 1.0f;
    float detail = 0.5f;
};

LIMN_FIELDS(Shadow) {
    LIMN_FIELD(
        method, .doc = "shadowing technique", .values = "auto map perspective volume hybrid");
    LIMN_FIELD(
        filter, .doc = "shadow map filtering", .values = "hard bilinear soft contact_hardening");
    LIMN_FIELD(resolution, "side length of a shadow map", "texels", 16, 4096);
    LIMN_FIELD(
        source_size, "diameter of the light source; for a directional light, an angle [rad]", "m",
        0, 100);
    LIMN_FIELD(cascades, "shadow map cascades of a directional light", "", 1, 4);
    LIMN_FIELD(distance, "shadow distance of a directional light, from the camera", "m", 0.1, 1e5);
    LIMN_FIELD(bias, "factor on the automatic bias; 1 needs no tuning, 0 = none", "", 0, 8);
    LIMN_FIELD(
        detail, "error up to which casters are drawn with fewer triangles; 0 = as they are",
        "texels", 0, 8);
}

/// Tag: the mesh instance casts no shadow.
struct NoShadow {};

}  // namespace limn
