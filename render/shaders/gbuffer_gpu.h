// Texture units of the G-buffer, for all shaders that read it. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kGbufferUnit = 5u;
const uint kDepthUnit = 6u;
const uint kGbufferMaterialUnit = 13u;
const uint kVelocityUnit = 14u;
const uint kGbufferKeyLightUnit = 35u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
