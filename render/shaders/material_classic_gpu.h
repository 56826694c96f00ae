// Block of materials with the shading models Blinn, Phong and Skin.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ClassicBlock {
    vec4 specular;  // ks; w: shininess
};

#ifdef __cplusplus
}  // namespace limn::layout
#endif
