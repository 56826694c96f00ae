// Underwater light and caustics, read from buffer textures. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// Header of a frame's water records (lib/under_water.glsl).
struct WaterLightHeader {
    vec4 counts;  // of UnderwaterRecord, MirrorRecord and CausticTile, in this order; w: first texel of the cells
    vec4 grid;    // of cells over the world: minimum x and z [m]; cells per meter along both
    vec4 cells;   // number along x and z; each is a texel: begin and end of its list of waters (one texel per water)
};

// A body of water, for shading points inside it.
struct UnderwaterRecord {
    vec4 origin;      // world [m]; w: x of the water's x axis in the world
    vec4 shape;       // z of that axis; half extents along x and z [m], 0 = unbounded; w: refractive index
    vec4 extinction;  // [1/m]; w: depth of the bottom [m], 0 = bottomless
    vec4 maps;        // first CausticTile and count, finest first; index of their LightRecord; maximum depth [m]
    vec4 bent;        // x and z, in water space, that light refracted by flat water travels per meter down;
                      // Caustics::strength; Caustics::shaft_steps
};

// A body of water, for shading points above it by the sunlight that it reflects.
struct MirrorRecord {
    vec4 origin;  // world [m]; w: x of the water's x axis in the world
    vec4 shape;   // z of that axis; its CausticTile; index of its LightRecord; maximum height [m]
    vec4 bent;    // x and z, in water space, that light reflected by flat water travels per meter up; reflectance; 0
};

// The tile of a caustic map in the atlas, for sampling.
struct CausticTile {
    vec4 window;  // minimum x and z in water space [m]; 1 / its size along both [1/m]
    vec4 rect;    // first texel in the atlas along both; texels along a side; 1: there is a map, 0: uniform light
    vec4 view;    // shadow view of the surfaces that its light hits, or -1; width of the border that blends into the
                  // next map, as a fraction of its side; distance over which its light is traced [m]
};

// A caustic map to render (caustics_rays.comp and the steps after it).
struct CausticRecord {
    vec4 window;   // minimum x and z in water space [m], its size along both [m]
    vec4 to_sun;   // in water space, unit; w: index of the water
    vec4 bent;     // x and z that the flat water's light travels per meter down, or up; distance over which it is
                   // traced [m]; transmittance, or reflectance, of the flat surface times the cosine
    vec4 shadows;  // LightRecord::shadow of the light
    vec4 world;    // toward the sun in world space; w: shadow view of the surfaces that its light hits, or -1
    vec4 grid;     // cells along a side; texels along a side; width of the rim of undisturbed rays [m]; kind, see below
    vec4 pool;     // half extents [m]; minimum height and 1 / (maximum - minimum) [m, 1/m]
    vec4 target;   // first texel in the atlas along both; first ray; Caustics::strength
    vec4 wires;    // Caustics::wires; 0; 0; 0
};

const uint kHeaderTexels = 3u;
const uint kUnderwaterTexels = 5u;
const uint kMirrorTexels = 3u;
const uint kCausticTileTexels = 3u;
const uint kCausticTexels = 9u;

const float kCausticsSimulated = 0.0;  // CausticMethod
const float kCausticsPool = 1.0;
const float kCausticsMirrored = 2.0;   // above the water

const uint kRayGroup = 64u;  // consecutive rays of one map, per work group

// Bindings.
const uint kWaterLightsUnit = 20u;
const uint kCausticMapsUnit = 21u;
const uint kCausticRecordsUnit = 20u;
const uint kCausticRaysBinding = 0u;
const uint kCausticLightBinding = 1u;
const uint kCausticMapsImage = 0u;

#ifdef __cplusplus
static_assert(sizeof(WaterLightHeader) == 16 * kHeaderTexels);
static_assert(sizeof(UnderwaterRecord) == 16 * kUnderwaterTexels);
static_assert(sizeof(MirrorRecord) == 16 * kMirrorTexels);
static_assert(sizeof(CausticTile) == 16 * kCausticTileTexels);
static_assert(sizeof(CausticRecord) == 16 * kCausticTexels);
}  // namespace limn::layout
#endif
