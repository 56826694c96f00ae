#pragma once

#include "ecs/components/surface.h"

#include <cstdint>

namespace limn {

// A landscape as a height field: height = f(x, z) of the parameters alone, so that it may be asked
// for anywhere and any number of triangles shows the same hills.
//
// Rolling hills are a fractal sum of noise in which an octave counts less the steeper the ground
// already is: debris fills the slopes while crests and valley floors keep their detail, as erosion
// would have it (I. Quilez, "Value noise derivatives", 2008). Mountains are ridged noise and
// take the place of hills in some regions; both are bent by a slow noise, so that ridges wander. No
// water runs here: valleys need not lead anywhere.

struct TerrainShape {
    Vec2 size = {100, 100};      ///< along x and z [m], > 0
    int divisions = 192;         ///< quads along each side, >= 1
    float height = 14.0f;        ///< from the lowest valleys to the highest crests, about [m]
    float feature_size = 45.0f;  ///< from hill to hill [m], > 0
    int octaves = 8;             ///< detail: each halves the size, 1 .. 16
    float ridges = 0.5f;         ///< share of the land that is mountains, 0 .. 1
    float erosion = 1.0f;        ///< how much slopes lose detail, 0 = none .. 4
    float warp = 0.35f;          ///< how much ridges wander, in feature sizes, 0 .. 2
    float clearing = 0.0f;       ///< radius of a level place in the middle [m], 0 = none
    float shore = 0.0f;          ///< an island: sinks to 0 over so far from its coast [m], 0 = no
    int seed = 1;                ///< another landscape
    bool colors = false;         ///< of rock, scrub and sand at the vertices
};

/// Height above y = 0 [m], between 0 and `height` give or take a tenth.
[[nodiscard]] float terrain_height(const TerrainShape& shape, float x, float z);

/// A grid centered at the origin; the texture covers it once, its top at -z. Normals are central
/// differences over one quad. With colors, scrub grows where it is not steep, and sand lies where
/// an island meets the sea; they are meant for a white material.
[[nodiscard]] MeshData make_terrain(const TerrainShape& shape);

template <typename Visitor>
void visit_fields(TerrainShape& shape, Visitor&& visit) {
    visit("size", shape.size, {.doc = "along x and z", .unit = "m", .min = 0.01, .max = 1e5});
    visit("divisions", shape.divisions, {.doc = "quads along each side", .min = 1, .max = 2048});
    visit(
        "height", shape.height,
        {.doc = "from valleys to crests", .unit = "m", .min = 0, .max = 1e4});
    visit(
        "feature_size", shape.feature_size,
        {.doc = "from hill to hill", .unit = "m", .min = 0.01, .max = 1e5});
    visit("octaves", shape.octaves, {.doc = "levels of detail", .min = 1, .max = 16});
    visit(
        "ridges", shape.ridges,
        {.doc = "share of the land that is mountains, not hills", .min = 0, .max = 1});
    visit("erosion", shape.erosion, {.doc = "how much slopes lose detail", .min = 0, .max = 4});
    visit(
        "warp", shape.warp,
        {.doc = "how much ridges wander, in feature sizes", .min = 0, .max = 2});
    visit(
        "clearing", shape.clearing,
        {.doc = "radius of a level place in the middle; 0 = none",
         .unit = "m",
         .min = 0,
         .max = 1e5});
    visit(
        "shore", shape.shore,
        {.doc = "an island: sinks to 0 over so far from its coast; 0 = no",
         .unit = "m",
         .min = 0,
         .max = 1e5});
    visit("colors", shape.colors, {.doc = "of rock, scrub and sand at the vertices"});
    visit("seed", shape.seed, {.doc = "another landscape", .min = 0, .max = 2147483647});
}

}  // namespace limn
