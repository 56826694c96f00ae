// Bindings of dazzle.frag. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kDazzlePointsUnit = 2u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
