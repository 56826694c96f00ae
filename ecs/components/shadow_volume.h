#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// What a light's shadow volumes are made of.
enum class VolumeKind : std::uint8_t {
    PerEdge,      ///< one volume a caster; if one of them is not closed, the light gets a map
    Mixed,        ///< that, and prisms of what is not closed
    PerTriangle,  ///< a prism for every triangle: four times the fill
};

/// From which end volumes are counted.
enum class StencilMode : std::uint8_t {
    Auto,   ///< z-pass for volumes that cannot hold the eye, z-fail for the others
    ZPass,  ///< from the eye: cheap, wrong by one for each volume that the eye is in
    ZFail,  ///< from the far end: always right
};

/// How far volumes go (shadow.extrusion-distance).
enum class Extrusion : std::uint8_t {
    Infinite,  ///< to the end of the world
    Constant,  ///< by `distance`
    Radius,    ///< to the light's radius: light leaks in behind the cap
    Plane,     ///< until no part of the cap is nearer than the radius; prisms only
};

/// How the light beside it counts its volumes, for Shadow with the method volume or hybrid. Without
/// this component the defaults hold.
struct ShadowVolume {
    VolumeKind kind = VolumeKind::PerEdge;
    StencilMode mode = StencilMode::Auto;
    Extrusion extrusion = Extrusion::Infinite;
    float distance = 100.0f;  ///< of Extrusion::Constant [m], > 0
    float cap_bias = 0.002f;  ///< the near cap lies this far beneath the caster's surface [m], >= 0
};

template <typename Visitor>
void visit_fields(ShadowVolume& volume, Visitor&& visit) {
    visit(
        "kind", volume.kind,
        {.doc = "what the volumes are made of", .values = "per_edge mixed per_triangle"});
    visit(
        "mode", volume.mode,
        {.doc = "from which end volumes are counted", .values = "auto z_pass z_fail"});
    visit(
        "extrusion", volume.extrusion,
        {.doc = "how far the volumes go", .values = "infinite constant radius plane"});
    visit(
        "distance", volume.distance,
        {.doc = "length of the volumes with the extrusion constant",
         .unit = "m",
         .min = 0.01,
         .max = 1e5});
    visit(
        "cap_bias", volume.cap_bias,
        {.doc = "how far the near cap lies beneath the caster's surface",
         .unit = "m",
         .min = 0,
         .max = 1});
}

}  // namespace limn
