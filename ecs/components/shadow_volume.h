#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: shadow.extrusion-distance

/// Geometry of a light's shadow volumes.
enum class VolumeKind : std::uint8_t {
    PerEdge,  ///< one silhouette volume per caster; if any mesh is not closed, the light uses a map
    Mixed,    ///< the same, with per-triangle prisms for meshes that are not closed
    PerTriangle,  ///< a prism for every triangle: four times the fill
};

/// Stencil counting method.
enum class StencilMode : std::uint8_t {
    Auto,   ///< z-pass for volumes that cannot contain the camera, z-fail for the others
    ZPass,  ///< counts from the camera: cheap, off by one for each volume containing the camera
    ZFail,  ///< counts from the far end: always correct
};

/// Extrusion distance of volumes (shadow.extrusion-distance).
enum class Extrusion : std::uint8_t {
    Infinite,  ///< to infinity
    Constant,  ///< by `distance`
    Radius,    ///< to the light's radius: light leaks behind the cap
    Plane,     ///< until the whole cap lies beyond the radius; prisms only
};

/// Settings of the light's shadow volumes, for a Shadow with the method volume or hybrid. If
/// absent, the defaults apply.
struct ShadowVolume {
    VolumeKind kind = VolumeKind::PerEdge;
    StencilMode mode = StencilMode::Auto;
    Extrusion extrusion = Extrusion::Infinite;
    float distance = 100.0f;
    float cap_bias = 0.002f;
};

LIMN_FIELDS(ShadowVolume) {
    LIMN_FIELD(kind, .doc = "geometry of the volumes", .values = "per_edge mixed per_triangle");
    LIMN_FIELD(mode, .doc = "stencil counting method", .values = "auto z_pass z_fail");
    LIMN_FIELD(
        extrusion, .doc = "extrusion distance of the volumes",
        .values = "infinite constant radius plane");
    LIMN_FIELD(distance, "length of the volumes with extrusion constant", "m", 0.01, 1e5);
    LIMN_FIELD(cap_bias, "depth of the near cap below the caster's surface", "m", 0, 1);
}

}  // namespace limn
