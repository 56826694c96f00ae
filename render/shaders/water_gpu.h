// Bodies of water, as water.vert and water.frag read them: texels of buffer textures. C++ and GLSL read the same text.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct WaterRecord {
    vec4 origin;      // world [m]; w: x of the water's x axis in the world
    vec4 shape;       // z of that axis; half extents along x and z [m], 0 = endless; w: refractive index
    vec4 absorption;  // [1/m]; w: depth of the bottom [m], 0 = deep
    vec4 scattering;  // back to the eye [1/m]; w: how it is drawn (pack_look)
    vec4 waves;       // first line and number of lines, first ring and number of rings
    vec4 ripples;     // texture coordinates = xz * xy + zw
    vec4 rippling;    // half extents of the grid [m], 0 = none; zw: seconds from the last step to the moment
                      // shown and to the moment before
    vec4 ocean;       // first layer and number of patches, 0 = none; points along a side; w: how far waves
                      // shift a planar reflection or what is seen through
    vec4 patches;     // 1 / side of each patch [1/m]
    vec4 variance;    // of the slopes of each patch
};

struct WaveLineRecord {
    vec4 run;    // k [rad/m]; sideways B d [m]
    vec4 phase;  // phase at the moment shown and at the moment before [rad]; amplitude [m]; lean
};

struct WaveRingRecord {
    vec4 place;  // center [m], first and last radius [m]
    vec4 phase;  // at the center, at the moment shown and at the moment before [rad]; k [rad/m]; amplitude [m]
    vec4 fade;   // radius from which it fades [m], 0 = none; 1: smooth edges; zw: front's way between the moments [m], 0
};

const int kWaterGrid = 8;  // cells along a side of a patch; even

const uint kWaterTexels = 10u;
const uint kWaveLineTexels = 2u;
const uint kWaveRingTexels = 3u;

#ifdef __cplusplus
static_assert(sizeof(WaterRecord) == 16 * kWaterTexels);
static_assert(sizeof(WaveLineRecord) == 16 * kWaveLineTexels);
static_assert(sizeof(WaveRingRecord) == 16 * kWaveRingTexels);
}  // namespace limn::layout
#endif
