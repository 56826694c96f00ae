// Keeps the pixels that shadow_classify.frag left undecided, to mark them in the stencil.
#version 450
#include "shadow_gpu.h"

layout(binding = kShadowMasksUnit) uniform sampler2DArray shadow_masks;

uniform int layer;

void main() {
    float mask = texelFetch(shadow_masks, ivec3(gl_FragCoord.xy, layer), 0).r;
    if (abs(mask - 0.5) > 0.25) {
        discard;
    }
}
