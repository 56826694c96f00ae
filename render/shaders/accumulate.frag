// Adds one sample image to a sum, by blending.
#version 450
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;

uniform float weight;

layout(location = 0) out vec4 sum;

void main() {
    sum = weight * texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
}
