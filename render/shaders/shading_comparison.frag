// Surfaces lit by two methods: one left and one right of the divider, or their difference to a power
// (shading_comparison_pass.h).
// Techniques: fakephong.metric-diffimage
#version 450
#include "lib/tone.glsl"
#include "shading_comparison_gpu.h"

layout(binding = kLeftRadianceUnit) uniform sampler2D left_radiance;
layout(binding = kRightRadianceUnit) uniform sampler2D right_radiance;

uniform int shows_difference;
uniform float divider;   // of the width
uniform float gain;      // of differences
uniform float exponent;

layout(location = 0) out vec4 radiance;

// Quantized to 8 bits, so that differences below one step become 0.
vec3 quantized(vec3 color) {
    return round(255.0 * clamp(color, 0.0, 1.0)) / 255.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 left = texelFetch(left_radiance, pixel, 0);
    vec4 right = texelFetch(right_radiance, pixel, 0);
    if (shows_difference == 0) {
        radiance = gl_FragCoord.x < divider * float(textureSize(left_radiance, 0).x) ? left : right;
        return;
    }
    vec3 difference = abs(quantized(left.rgb) - quantized(right.rgb));
    vec3 displayed = pow(min(gain * difference, 1.0), vec3(exponent));
    radiance = vec4(srgb_to_linear(displayed), left.a);
}
