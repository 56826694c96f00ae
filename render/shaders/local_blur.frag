// One direction of up to four Gaussian blurs of an image's luminance, one per component.
//   SOURCE  0: radiance; 1: the x component, for all four; 2: each component separately
//   RADIUS  of the widest [texels]; a constant, as a software OpenGL is slow at indexing weights by a variable
// Techniques: hdr.dodge-burn
#version 450
#include "lib/tone.glsl"
#include "tone_gpu.h"
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D source;
layout(std140, binding = kBlurWeightsBinding) uniform Weights {
    BlurWeights weights;
};

uniform ivec2 direction;  // one texel

layout(location = 0) out vec4 blurred;

vec4 fetch(ivec2 at) {
    vec4 texel = texelFetch(source, at, 0);
#if SOURCE == 0
    return vec4(luminance(sanitize_light(texel.rgb, kMaxHalf)));
#elif SOURCE == 1
    return texel.xxxx;
#else
    return texel;
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(source, 0) - 1;
    blurred = weights.weight[0] * fetch(at);
    for (int i = 1; i <= RADIUS; ++i) {
        // Clamps to the edge.
        vec4 both = fetch(max(at - i * direction, ivec2(0))) + fetch(min(at + i * direction, last));
        blurred += weights.weight[i] * both;
    }
}
