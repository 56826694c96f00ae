// One material, read from a texture buffer as kMaterialTexels RGBA32F texels.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct MaterialRecord {
    vec4 base_color;  // linear, opacity
    vec4 emission;    // w: strength of the normal map
    vec4 factors;     // metalness, roughness, strength of the occlusion map, alpha cutoff
    vec4 specular;    // ks of Blinn, Phong and Skin; w: shininess
    vec4 uv_map[10];  // of texture i: 2 i = rows (u: xy, v: zw) of its 2x3 map, 2 i + 1 = offset xy, uv set z
    vec4 skin;        // color of Skin's rim; w: 1 = wide rim
    vec4 unused;
};

const uint kMaterialTexels = 16u;

#ifdef __cplusplus
static_assert(sizeof(MaterialRecord) == 16 * kMaterialTexels);
}  // namespace limn::layout
#endif
