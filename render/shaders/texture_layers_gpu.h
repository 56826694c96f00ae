// Bindings of texture_layers.frag. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kLayerUnit = 0u;
const uint kLayerMapUnit = 1u;
const uint kLayersBelowUnit = 2u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
