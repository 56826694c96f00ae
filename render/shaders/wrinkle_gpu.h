// Input of wrinkle.comp. Shared by C++ and GLSL.
//
// A rest mesh is a block of texels of two 32-bit numbers, or three consecutive blocks for strain. First one texel per
// vertex plus the end: its first triangle as a texel of the first block, and its mask and its shortening at rest, 16
// bits each; the second and third block hold the angle and the sign of its tangent frame instead (WrinkleState::frames;
// 0: none). A second layer is another block, with its own mask. Then two texels per triangle at a vertex, whose third
// corner is that vertex: the two other corners, and the direction across its wrinkles as weights of the edges to them,
// times the square root of the triangle's weight at the vertex (the weight itself if lengths are averaged). Flags in
// the highest bits of the first of them mark one more texel, with the weight and the third corner: for a triangle that
// is measured by its stretch, and for one that is not at that vertex. Last, for displaced skin, the fold heights of
// both layers per vertex.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// One instance: nine texels of four 32-bit numbers.
struct WrinkleJob {
    uint rest;         // first texel of the mesh
    uint vertex_count;
    uint slot;         // its first vertex in the buffers of deformed vertices
    uint first_group;  // work group of its first vertex
    uint method;       // kWrinkle*
    float lambda;
    float beta;
    float slack;
    float fold_fraction;
    uint driver;       // kWrinkleBy*
    uint mean_length;  // 1: lengths are averaged, not their squares
    float activation;
    uint second;       // offset of the second block (for strain) or second layer, or 0
    uint third;
    float own_weight;   // weights of the method, and of alpha which replaces it
    float shade_weight;
    vec4 folds[4];     // FoldTable
    uint heights;      // offset of the heights from the first texel of the mesh; 0: none
    float displacement; // fraction of them that displaces vertices
    float resting;      // weight of the shortening at rest
    uint unused;
};

const uint kWrinkleJobTexels = 9u;
const uint kWrinkleGroup = 64u;        // vertices
const uint kWrinkleGroupsWide = 1024u; // groups of a dispatch along x

// WrinkleMethod
const uint kWrinkleAlpha = 1u;
const uint kWrinkleDirectional = 2u;
const uint kWrinkleBump = 3u;
const uint kWrinkleSphere = 4u;
const uint kWrinkleIsometric = 5u;
const uint kWrinkleBlend = 6u;
const uint kWrinkleStrainView = 7u;
const uint kWrinkleModel = 8u;
const uint kWrinklePhoto = 9u;
const uint kWrinkleColumns = 15u;  // chosen per fragment, by WrinkleColumns

// WrinkleDriver
const uint kWrinkleByStrain = 2u;
const uint kWrinkleByRadius = 3u;

const uint kFoldSteps = 16u;
const uint kWrinkleStretch = 0x80000000u;
const uint kWrinkleAway = 0x40000000u;

// Bindings.
const uint kWrinkleJobsUnit = 0u;
const uint kWrinkleGroupsUnit = 1u;
const uint kWrinkleRestUnit = 2u;
const uint kWrinklePositionsBinding = 0u;
const uint kWrinklesBinding = 1u;
const uint kFoldHeightsBinding = 2u;

#ifdef __cplusplus
static_assert(sizeof(WrinkleJob) == 16 * kWrinkleJobTexels);
}  // namespace limn::layout
#endif
