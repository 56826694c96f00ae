// Bindings of texture_combine.frag. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kCombinedWaterUnit = 0u;
const uint kCombinedGratingUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
