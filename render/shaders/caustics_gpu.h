// Light under water, as shaders read it: texels of buffer textures. C++ and GLSL read the same text.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// A body of water as what lies in it is lit (lib/under_water.glsl).
struct SunkenRecord {
    vec4 origin;      // world [m]; w: x of the water's x axis in the world
    vec4 shape;       // z of that axis; half extents along x and z [m], 0 = endless; w: refractive index
    vec4 extinction;  // [1/m]; w: depth of the bottom [m], 0 = deep
    vec4 window;      // of its map: least x and z in the water's own space [m]; 1 / size of it
    vec4 map;         // layer of its map or -1 = none; its shadow view or -1; whose light: index of the record;
                      // depth down to which it reaches [m]
    vec4 bent;        // how far the flat water's light goes along the water's x and z on a meter down; Caustics::strength; 0
};

// A map to be made (caustics_rays.comp and those after it).
struct CausticRecord {
    vec4 window;   // least x and z in the water's own space [m], its size along both [m]
    vec4 to_sun;   // in the water's own space, unit; w: index of the water
    vec4 bent;     // how far the flat water's light goes along x and z on a meter down; greatest depth [m];
                   // what the flat surface lets through, times the cosine
    vec4 shadows;  // the light's shadow: LightRecord::shadow
    vec4 world;    // toward the sun in the world; w: shadow view of what lies below, or -1
    vec4 grid;     // cells of a side; texels of a side; width of the rim where rays go straight [m]; CausticMethod
    vec4 pool;     // half extents [m]; least height and 1 / (greatest - least) [m, 1/m]
};

const uint kSunkenTexels = 6u;
const uint kCausticTexels = 7u;

#ifdef __cplusplus
static_assert(sizeof(SunkenRecord) == 16 * kSunkenTexels);
static_assert(sizeof(CausticRecord) == 16 * kCausticTexels);
}  // namespace limn::layout
#endif
