// Block of materials that transmit light.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ClearBlock {
    vec4 medium;      // transmission, refractive index, thickness [m] before scaling, dispersion
    vec4 absorption;  // [1/m]; w unused
};

// Bindings.
const uint kBehindClearUnit = 22u;
const uint kBehindClearDepthUnit = 23u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
