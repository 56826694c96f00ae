// Block of materials with the shading model Skin.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct SkinBlock {
    vec4 rim;  // color; w: 1 = wide
};

#ifdef __cplusplus
}  // namespace limn::layout
#endif
