// One view of the shadow atlas, read from a texture buffer as kShadowViewTexels RGBA32F texels.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ShadowViewRecord {
    vec4 row_s;     // shadow_from_world: dot with (position, 1) gives texel x times q,
    vec4 row_t;     // texel y times q,
    vec4 row_r;     // depth times q
    vec4 row_q;     // and q, which is > 0 in front of the light
    vec4 plane_s;   // columns of world_from_shadow: dot with a plane in world space gives the plane's
    vec4 plane_t;   // components in shadow space
    vec4 plane_r;
    vec4 rect;      // texels that may be read: left, bottom, right, top
    vec4 settings;  // ShadowFilter, scale of the bias, penumbra for a depth of 1 and its maximum radius [texels]
    vec4 splits;    // of the first cascade: far ends of all [m along the camera's axis], INFINITY after the last
};

const uint kShadowViewTexels = 10u;

// Bindings.
const uint kShadowAtlasUnit = 15u;
const uint kShadowViewsUnit = 16u;
const uint kShadowMasksUnit = 17u;

#ifdef __cplusplus
static_assert(sizeof(ShadowViewRecord) == 16 * kShadowViewTexels);
}  // namespace limn::layout
#endif
