// Light under water, as shaders read it: texels of buffer textures. C++ and GLSL read the same text.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// What stands before the records of a frame's waters (lib/under_water.glsl).
struct WaterLightHead {
    vec4 counts;  // of SunkenRecord; of MirrorRecord after those; of CausticPlace after those; first texel of the cells
    vec4 grid;    // of cells over the world: its least x and z [m]; cells a meter along both
    vec4 cells;   // along x and z; each is a texel: where its list of waters begins, a texel a water, and ends
};

// A body of water as what lies in it is lit.
struct SunkenRecord {
    vec4 origin;      // world [m]; w: x of the water's x axis in the world
    vec4 shape;       // z of that axis; half extents along x and z [m], 0 = endless; w: refractive index
    vec4 extinction;  // [1/m]; w: depth of the bottom [m], 0 = deep
    vec4 maps;        // its first CausticPlace and how many, the finer first; whose light: index of the record;
                      // depth down to which they reach [m]
    vec4 bent;        // how far the flat water's light goes along the water's x and z on a meter down; Caustics::strength;
                      // Caustics::shaft_steps
};

// A body of water as what stands above it is lit by the sun that it mirrors.
struct MirrorRecord {
    vec4 origin;  // world [m]; w: x of the water's x axis in the world
    vec4 shape;   // z of that axis; its CausticPlace; whose light: index of the record; height below which it is seen [m]
    vec4 bent;    // how far the flat water's light goes along the water's x and z on a meter up; share that it mirrors; 0
};

// A map where it is read.
struct CausticPlace {
    vec4 window;  // least x and z in the water's own space [m]; 1 / size of it
    vec4 rect;    // first texel of the atlas along both; texels of a side; 1: there is a map, 0: light is even
    vec4 view;    // shadow view of what its light meets, or -1; share of the map at its edge that gives way to the next
                  // one; how far its light is followed [m]
};

// A map to be made (caustics_rays.comp and those after it).
struct CausticRecord {
    vec4 window;   // least x and z in the water's own space [m], its size along both [m]
    vec4 to_sun;   // in the water's own space, unit; w: index of the water
    vec4 bent;     // how far the flat water's light goes along x and z on a meter down, or up; how far it is followed [m];
                   // what the flat surface lets through, or mirrors, times the cosine
    vec4 shadows;  // the light's shadow: LightRecord::shadow
    vec4 world;    // toward the sun in the world; w: shadow view of what its light meets, or -1
    vec4 grid;     // cells of a side; texels of a side; width of the rim where rays go straight [m]; kind, see below
    vec4 pool;     // half extents [m]; least height and 1 / (greatest - least) [m, 1/m]
    vec4 place;    // first texel of the atlas along both; first ray; Caustics::strength
};

const uint kHeadTexels = 3u;
const uint kSunkenTexels = 5u;
const uint kMirrorTexels = 3u;
const uint kPlaceTexels = 3u;
const uint kCausticTexels = 8u;

const float kCausticsSimulated = 0.0;  // CausticMethod
const float kCausticsPool = 1.0;
const float kCausticsMirrored = 2.0;   // above the water

const uint kRayGroup = 64u;  // rays of a work group: of one map, one after the other

#ifdef __cplusplus
static_assert(sizeof(WaterLightHead) == 16 * kHeadTexels);
static_assert(sizeof(SunkenRecord) == 16 * kSunkenTexels);
static_assert(sizeof(MirrorRecord) == 16 * kMirrorTexels);
static_assert(sizeof(CausticPlace) == 16 * kPlaceTexels);
static_assert(sizeof(CausticRecord) == 16 * kCausticTexels);
}  // namespace limn::layout
#endif
