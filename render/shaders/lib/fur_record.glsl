// Records of coats of fur, by the flags of an instance.

#include "fur_gpu.h"

layout(binding = kFursUnit) uniform samplerBuffer furs;  // FurRecord

vec4 fur_texel(uint flags, int i) {
    return texelFetch(furs, int((flags >> kFurShift & kFurMask) * kFurTexels) + i);
}
