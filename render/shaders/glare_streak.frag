// Spreads the sum so far, and the weighted source, along a line with [1 2 1] / 4 at a distance. Black outside.
#version 450
#include "fullscreen_gpu.h"
#include "glare_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D source;
layout(binding = kGlareSumUnit) uniform sampler2D sum;

uniform vec2 offset;   // [texels]
uniform float source_weight;
uniform float sum_weight;

layout(location = 0) out vec4 streak;

vec3 light_at(vec2 position) {
    vec2 uv = position / vec2(textureSize(source, 0));
    return sum_weight * texture(sum, uv).rgb + source_weight * texture(source, uv).rgb;
}

void main() {
    vec2 at = gl_FragCoord.xy;
    streak = vec4(0.5 * light_at(at) + 0.25 * (light_at(at - offset) + light_at(at + offset)), 1.0);
}
