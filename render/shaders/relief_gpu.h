// The block of materials with relief (lib/relief_surface.glsl), and bindings.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ReliefBlock {
    vec4 search;  // depth of the relief [m], steps, refinements, Material::tessellation [px]
};

// Bindings.
const uint kCurvaturesUnit = 32u;

#ifdef __cplusplus
static_assert(sizeof(ReliefBlock) == 16);
}  // namespace limn::layout
#endif
