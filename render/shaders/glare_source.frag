// The light above a threshold, at half resolution: thresholds each pixel, then averages four.
#version 450
#include "lib/tone.glsl"
#include "tone_gpu.h"
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;

uniform float threshold;  // luminance

layout(location = 0) out vec4 above;

vec3 above_at(ivec2 at) {
    bool inside = all(lessThan(at, textureSize(scene_radiance, 0)));
    vec3 color = inside ? texelFetch(scene_radiance, at, 0).rgb : vec3(0.0);
    color = is_finite(color) ? clamp(color, 0.0, kMaxHalf) : vec3(0.0);
    float light = luminance(color);
    return light > threshold ? color * (1.0 - threshold / light) : vec3(0.0);
}

void main() {
    ivec2 at = 2 * ivec2(gl_FragCoord.xy);
    vec3 sum = above_at(at) + above_at(at + ivec2(1, 0)) + above_at(at + ivec2(0, 1)) + above_at(at + 1);
    above = vec4(0.25 * sum, 1.0);
}
