// What tilts the normals of water, as water.frag and texture_waves.frag read it: texels of buffer textures. C++ and
// GLSL read the same text.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct WaterDetailRecord {
    vec4 waves;      // layer of their texture, -1 = none; 1 / side of its tile [1/m]; variance of the slopes of waves
                     // that found no place in it; number of layers of the normal map
    vec4 layers[4];  // 1 / side of a copy [1/m]; where it is, in copies; strength
};

struct TextureWaveRecord {
    vec4 wave;  // whole waves along x and along z of the tile; phase at the moment shown [rad]; amplitude 2 pi / tile
};

const uint kWaterDetailTexels = 5u;

#ifdef __cplusplus
static_assert(sizeof(WaterDetailRecord) == 16 * kWaterDetailTexels);
}  // namespace limn::layout
#endif
