// Bindings and records of airlight.frag. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// After a texel with the number of lights, of each: the first four texels of its LightRecord; then the axis of its cone, unit, zero for a point light,
// and the cosine of the cone's half angle.
const uint kAirlightTexels = 5u;

const uint kAirlightDepthUnit = 0u;
const uint kAirlightUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
