// Normal detail of water, for water.frag and texture_waves.frag: texels of buffer textures. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct WaterDetailRecord {
    vec4 waves;      // layer of their texture, -1 = none; 1 / side of its tile [1/m]; slope variance of the waves
                     // that do not fit in it; number of layers of the normal map
    vec4 layers[4];  // 1 / side of a copy [1/m]; its offset [copies]; strength
};

struct TextureWaveRecord {
    vec4 wave;  // periods along x and z of the tile; current phase [rad]; amplitude 2 pi / tile
};

const uint kWaterDetailTexels = 5u;

// Bindings.
const uint kDetailMapUnit = 23u;
const uint kDetailWavesUnit = 24u;
const uint kWaterDetailsUnit = 25u;
const uint kTextureWavesUnit = 0u;

#ifdef __cplusplus
static_assert(sizeof(WaterDetailRecord) == 16 * kWaterDetailTexels);
}  // namespace limn::layout
#endif
