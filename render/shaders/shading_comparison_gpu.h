// Texture units of images that two methods of shading have drawn. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kLeftRadianceUnit = 1u;
const uint kRightRadianceUnit = 2u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
