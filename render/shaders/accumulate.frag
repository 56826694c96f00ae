// Adds one sample image to a sum, by blending; or copies the sum. SampleMean::Displayed compresses samples and expands
// their mean.
#version 450
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;

uniform float weight;
uniform float compression;  // exposure: c / (1 + exposure * largest channel); negative: its inverse; 0: none

layout(location = 0) out vec4 sum;

void main() {
    vec4 radiance = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
    float largest = max(max(radiance.r, radiance.g), max(radiance.b, 0.0));
    radiance.rgb /= max(1.0 + compression * largest, 1e-6);
    sum = weight * radiance;
}
