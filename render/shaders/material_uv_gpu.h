// Of a material whose textures do not all use the first uv set untransformed.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct UvBlock {
    vec4 map[10];  // of texture i: 2 i = rows (u: xy, v: zw) of its 2x3 map, 2 i + 1 = offset xy, uv set z
};

#ifdef __cplusplus
}  // namespace limn::layout
#endif
