#pragma once

#include "ecs/components/surface.h"

namespace limn {

/// A boulder: a ball cut by planes all around, with worn edges and rough faces. Star-shaped about
/// its center, so that every direction meets its surface once.
struct BoulderShape {
    Vec3 size = {1, 0.7f, 0.9f};
    int facets = 18;
    float wear = 0.55f;
    float roughness = 0.07f;
    int segments = 64;
    int rings = 32;
    int seed = 1;
};

LIMN_FIELDS(BoulderShape) {
    LIMN_FIELD(size, "about this wide, high and deep", "m", 1e-3, 1e4);
    LIMN_FIELD(facets, "number of planes", "", 6, 200);
    LIMN_FIELD(wear, "roundness of the edges: 0 fresh, 1 a pebble", "", 0, 1);
    LIMN_FIELD(roughness, "bumps / radius", "", 0, 0.5);
    LIMN_FIELD(segments, "around the vertical axis", "", 3, 2048);
    LIMN_FIELD(rings, "from pole to pole", "", 2, 1024);
    LIMN_FIELD(seed, "random seed", "", 0, 2147483647);
}

[[nodiscard]] MeshData make_boulder(const BoulderShape& shape);

}  // namespace limn
