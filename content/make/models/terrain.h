#pragma once

#include "ecs/components/surface.h"

#include <cstdint>

namespace limn {

// Terrain as a height field: height = f(x, z) of the parameters only, so that it can be evaluated
// anywhere and any number of triangles shows the same hills.
//
// Rolling hills are fractal noise in which an octave is attenuated by the slope of the previous
// ones: debris fills the slopes while crests and valley floors keep their detail, like erosion (I.
// Quilez, "Value noise derivatives", 2008). Mountains are ridged noise and replace hills in some
// regions; both are domain-warped by low-frequency noise. No hydraulic erosion: valleys need not
// drain anywhere.

inline constexpr float kSeabed = 0.05f;

struct TerrainShape {
    Vec2 size = {100, 100};
    int divisions = 192;
    float height = 14.0f;
    float feature_size = 45.0f;
    int octaves = 8;
    float ridges = 0.5f;
    float erosion = 1.0f;
    float warp = 0.35f;
    float clearing = 0.0f;
    float shore = 0.0f;
    int seed = 1;
    bool colors = false;
};

LIMN_FIELDS(TerrainShape) {
    LIMN_FIELD(size, "along x and z", "m", 0.01, 1e5);
    LIMN_FIELD(divisions, "quads along each side", "", 1, 2048);
    LIMN_FIELD(height, "from valleys to crests", "m", 0, 1e4);
    LIMN_FIELD(feature_size, "distance between hills", "m", 0.01, 1e5);
    LIMN_FIELD(octaves, "of noise: each halves the feature size", "", 1, 16);
    LIMN_FIELD(ridges, "fraction of the land with mountains instead of hills", "", 0, 1);
    LIMN_FIELD(erosion, "loss of detail on slopes", "", 0, 4);
    LIMN_FIELD(warp, "domain warp in feature sizes", "", 0, 2);
    LIMN_FIELD(
        clearing, "radius of a flat area in the center, whose height limn check prints; 0 = none",
        "m", 0, 1e5);
    LIMN_FIELD(
        shore,
        "island: width of the slope to the seabed around it, which falls to the edges; 0 = none",
        "m", 0, 1e5);
    LIMN_FIELD(colors, "vertex colors of rock, scrub and sand");
    LIMN_FIELD(seed, "random seed", "", 0, 2147483647);
}

/// Height above y = 0 [m], between 0 and `height` to within a tenth. An island meets the sea at 0
/// and goes down to a seabed at -kSeabed of its height, so that its rim does not show through
/// water.
[[nodiscard]] float terrain_height(const TerrainShape& shape, float x, float z);

/// A grid centered at the origin; the texture covers it once, its top at -z. Normals are central
/// differences over one quad. With colors, scrub grows where it is not steep, and sand lies where
/// an island meets the sea; they are meant for a white material.
[[nodiscard]] MeshData make_terrain(const TerrainShape& shape);

}  // namespace limn
