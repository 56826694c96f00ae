// Spreads the sum so far, and a share of the source, along a line with [1 2 1] / 4 at a distance. Black outside.
#version 450
#include "fullscreen_gpu.h"
#include "glare_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D source;
layout(binding = kGlareSumUnit) uniform sampler2D sum;

uniform vec2 offset;   // [texels]
uniform float share;   // weight of the source
uniform float sum_weight;  // weight of the sum

layout(location = 0) out vec4 streak;

vec3 light_at(vec2 place) {
    vec2 uv = place / vec2(textureSize(source, 0));
    return sum_weight * texture(sum, uv).rgb + share * texture(source, uv).rgb;
}

void main() {
    vec2 at = gl_FragCoord.xy;
    streak = vec4(0.5 * light_at(at) + 0.25 * (light_at(at - offset) + light_at(at + offset)), 1.0);
}
