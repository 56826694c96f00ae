// Block of materials with the shading model Hair; made by render/material/hair_lobes.h.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct HairBlock {
    vec4 azimuth;  // concentration and peak of the lobe TT, then of TRT
    vec4 fiber;    // absorption by the color's squared logarithm; scattered fraction; cosine, sine of the scales' tilt
};

#ifdef __cplusplus
static_assert(sizeof(HairBlock) == 32);
}  // namespace limn::layout
#endif
