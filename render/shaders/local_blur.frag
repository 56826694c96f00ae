// One direction of up to four Gaussian blurs at once, a component each, of a picture's luminance.
//   SOURCE  0: radiance; 1: the x component, for all four; 2: the components, each its own
//   RADIUS  of the widest [texels]; known when compiling, as a software OpenGL fetches weights by a variable slowly
#version 450
#include "lib/tone.glsl"
#include "tone_gpu.h"

layout(binding = 0) uniform sampler2D source;
layout(std140, binding = 2) uniform Weights {
    BlurWeights weights;
};

uniform ivec2 direction;  // one texel

layout(location = 0) out vec4 blurred;

vec4 fetch(ivec2 at) {
    vec4 texel = texelFetch(source, at, 0);
#if SOURCE == 0
    return vec4(luminance(clean_light(texel.rgb, kMostLight)));
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
        // Beyond the edge the picture goes on as it is there.
        vec4 both = fetch(max(at - i * direction, ivec2(0))) + fetch(min(at + i * direction, last));
        blurred += weights.weight[i] * both;
    }
}
