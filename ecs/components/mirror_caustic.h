#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// Techniques: caustic.reflection-plane

/// With a MeshInstance: reflective caustics on a plane, like those of a ring on a table, lit by the
/// sun or, if there is none, the first lamp. The mesh is drawn again with its vertices moved to
/// where they reflect the light; a finer mesh gives a finer pattern.
struct MirrorCaustic {
    Vec3 normal = {0, 1, 0};
    float offset = 0;
    Vec3 color = {1, 1, 1};
    float strength = 1;
    float plane_exponent = 3;
    float surface_exponent = 3;
    float max_distance = 1000;
    float max_height = 1e6f;
    float wires = 0;
};

LIMN_FIELDS(MirrorCaustic) {
    LIMN_FIELD(normal, "normal of the plane, toward the reflector");
    LIMN_FIELD(offset, "offset of the plane along its normal", "m");
    LIMN_FIELD(color, "diffuse color of the plane", "", 0, 1000);
    LIMN_FIELD(strength, "factor on the added light", "", 0, 1000);
    LIMN_FIELD(
        plane_exponent, .doc = "exponent of the cosine at the plane", .min = 0, .max = 100,
        .renamed = "power_plane");
    LIMN_FIELD(
        surface_exponent, .doc = "exponent of the cosine at the reflector", .min = 0, .max = 100,
        .renamed = "power_surface");
    LIMN_FIELD(
        max_distance, .doc = "largest ray length", .unit = "m", .min = 0.001, .max = 1e6,
        .renamed = "farthest");
    LIMN_FIELD(
        max_height, .doc = "surfaces higher above the plane contribute no light", .unit = "m",
        .min = 0, .max = 1e6, .renamed = "highest");
    LIMN_FIELD(
        wires,
        .doc =
            "to look at the method: radiance of the edges of the moved mesh, drawn over its light; "
            "0: none",
        .min = 0, .max = 1000);
}

}  // namespace limn
