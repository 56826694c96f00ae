// Bodies of water, for water.vert and water.frag: texels of buffer textures. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct WaterRecord {
    vec4 origin;      // world [m]; w: x of the water's x axis in the world
    vec4 shape;       // z of that axis; half extents along x and z [m], 0 = unbounded; w: refractive index
    vec4 absorption;  // [1/m]; w: depth of the bottom [m], 0 = bottomless
    vec4 scattering;  // backscatter [1/m]; w: rendering options (pack_look)
    vec4 waves;       // first line and number of lines, first ring and number of rings
    vec4 ripples;     // texture coordinates = xz * xy + zw
    vec4 rippling;    // half extents of the grid [m], 0 = none; zw: time from the last step to the current and to
                      // the previous frame [s]
    vec4 ocean;       // first layer and number of patches, 0 = none; points along a side; w: strength of the shift
                      // of planar reflection and refraction by waves
    vec4 patches;     // 1 / side of each patch [1/m]
    vec4 variance;    // slope variance of each patch
    vec4 foam;        // Jacobian below which waves are white, -1 = none; 1 / time constant of the foam [1/s]
};

struct WaveLineRecord {
    vec4 run;    // wave vector k [rad/m]; horizontal amplitude B d [m]
    vec4 phase;  // current and previous phase [rad]; amplitude [m]; lean
};

struct WaveRingRecord {
    vec4 circle; // center [m], inner and outer radius [m]
    vec4 phase;  // at the center, current and previous [rad]; k [rad/m]; amplitude [m]
    vec4 fade;   // radius from which it fades [m], 0 = none; 1: smooth edges; offset of its radii in the previous
                 // frame [m]; 0
};

const int kHighestTile = 32;    // side of the tiles of water_highest.frag [px]
const float kNoHeight = 1e9;
const int kWaterGrid = 8;  // cells along a side of a patch; even

const uint kWaterTexels = 11u;
const uint kWaveLineTexels = 2u;
const uint kWaveRingTexels = 3u;

// Bindings.
const uint kWaterPatchesUnit = 0u;
const uint kVisibleWaterUnit = 0u;
const uint kWatersUnit = 1u;
const uint kWaveLinesUnit = 2u;
const uint kWaveRingsUnit = 3u;
const uint kRippleAtlasUnit = 4u;
const uint kOceanShiftUnit = 6u;
const uint kPreviousOceanShiftUnit = 28u;
const uint kOceanSlopeUnit = 14u;
const uint kOceanFoamUnit = 17u;
const uint kBehindWaterUnit = 5u;
const uint kBehindWaterDepthUnit = 26u;
const uint kHighestWaterUnit = 13u;
const uint kColumnSourceUnit = 0u;
const uint kWaterCopyDepthUnit = 1u;
const uint kWaterReflectionUnit = 22u;
const uint kFoamPatternUnit = 29u;
const uint kFloorMapUnit = 27u;
const uint kReflectionImageUnit = 32u;
const uint kWaterVeilDepthUnit = 5u;

#ifdef __cplusplus
static_assert(sizeof(WaterRecord) == 16 * kWaterTexels);
static_assert(sizeof(WaveLineRecord) == 16 * kWaveLineTexels);
static_assert(sizeof(WaveRingRecord) == 16 * kWaveRingTexels);
}  // namespace limn::layout
#endif
