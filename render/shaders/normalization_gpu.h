// Binding of the cube map that normalizes vectors (render/light/normalization_cube.h).

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kNormalizationUnit = 38u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
