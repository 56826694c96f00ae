// Two scrolling copies of water under a grating: kd = (kd1 + kd2) a + kd3 (1 - a), with a the grating's alpha.
// Techniques: tex.combine
#version 450
#include "lib/tone.glsl"
#include "texture_combine_gpu.h"

layout(binding = kCombinedWaterUnit) uniform sampler2D water;    // repeats
layout(binding = kCombinedGratingUnit) uniform sampler2D grating;  // repeats

uniform vec2 size;     // of the target [px]
uniform vec2 offset;   // of the first copy along u, of the second along v, 0 .. 1
uniform float gain;    // of the sum
uniform bool encoded;  // the target is sRGB

layout(location = 0) out vec4 color;

void main() {
    vec2 uv = gl_FragCoord.xy / size;
    vec3 both = textureLod(water, uv + vec2(offset.x, 0.0), 0.0).rgb + textureLod(water, uv + vec2(0.0, offset.y), 0.0).rgb;
    vec4 over = textureLod(grating, uv, 0.0);
    vec3 sum = mix(over.rgb, gain * both, over.a);
    color = vec4(encoded ? srgb_encode(clamp(sum, 0.0, 1.0)) : sum, 1.0);
}
