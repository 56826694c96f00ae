// Block of materials with the shading model Strand.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct StrandBlock {
    vec4 direction;  // xy: of the strands along tangent and bitangent, unit
};

#ifdef __cplusplus
}  // namespace limn::layout
#endif
