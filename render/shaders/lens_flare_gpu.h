// Bindings of lens_flare.vert, beside disk_visibility_gpu.h. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kLensSpritesUnit = 0u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
