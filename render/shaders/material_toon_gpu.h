// Block of materials with the shading model Toon. Its ramp divides the light 0 .. 1 into equal bands of flat color with
// narrow blends between them.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kMaxToonBands = 16u;
const float kToonBlend = 4.0 / 256.0;  // width of a blend, also at the rim of highlights

struct ToonBlock {
    vec4 bands[kMaxToonBands];  // colors from dark to lit; w of the first: number of bands
};

#ifdef __cplusplus
}  // namespace limn::layout
#endif
