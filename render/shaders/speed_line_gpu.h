// Bindings of speed_line.vert. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kSpeedLinesUnit = 0u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
