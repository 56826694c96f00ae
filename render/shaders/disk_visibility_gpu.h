// Bindings of disk_visibility.frag, and of shaders that read its texture. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kDiskDepthUnit = 0u;
const uint kDiskSourcesUnit = 1u;
const uint kVisibilityUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
