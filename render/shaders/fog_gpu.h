// Height fog relative to the camera (render/environment/fog_block.h). Shared by C++ and GLSL; std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
#endif
#include "render/shaders/view_gpu.h"

#ifdef __cplusplus
namespace limn::layout {
#endif

struct FogBlock {
    vec4 density;  // extinction at the camera [1/m], 0: no fog; 1 / its scale height [1/m]; forward scattering
    vec4 ambient;  // radiance scattered from the environment
    vec4 sun;      // irradiance of the sun
    vec4 to_sun;   // world, unit
};

const uint kFogBinding = kEffectBlocks + 0u;

// Bindings.
const uint kFogDepthUnit = 0u;

#ifdef __cplusplus
static_assert(sizeof(FogBlock) == 64);
}  // namespace limn::layout
#endif
