// Block of materials with the shading models Blinn, Phong and Skin.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ClassicBlock {
    vec4 specular;  // ks; w: shininess, negative if the roughness of surface samples lowers it
};

#ifdef __cplusplus
}  // namespace limn::layout
#endif
