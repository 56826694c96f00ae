// The texture of angles (lib/acos_table.glsl).

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// Bindings.
const uint kAcosUnit = 0u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
