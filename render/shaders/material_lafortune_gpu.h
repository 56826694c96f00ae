// Block of materials with the shading model Lafortune.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct LafortuneLobeRecord {
    vec4 across;    // Cx = Cy for red, green and blue; w of the first: number of lobes
    vec4 along;     // Cz
    vec4 exponent;  // n
};

const uint kLafortuneTexels = 3u;  // per lobe

#ifdef __cplusplus
static_assert(sizeof(LafortuneLobeRecord) == 16 * kLafortuneTexels);
}  // namespace limn::layout
#endif
