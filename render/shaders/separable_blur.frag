// One axis of a blur of 7 x 7 pixels. Clamps to the edge.
#version 450
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D source;

uniform ivec2 axis;  // (1, 0) or (0, 1)
uniform vec3 negative_weights;  // weights of the pixels -3, -2, -1
uniform float center_weight;
uniform vec3 positive_weights;  // 1, 2, 3

layout(location = 0) out vec4 blurred;

vec4 fetch(int offset) {
    ivec2 at = ivec2(gl_FragCoord.xy) + offset * axis;
    return texelFetch(source, clamp(at, ivec2(0), textureSize(source, 0) - 1), 0);
}

void main() {
    blurred = negative_weights.x * fetch(-3) + negative_weights.y * fetch(-2) + negative_weights.z * fetch(-1)
              + center_weight * fetch(0)
              + positive_weights.x * fetch(1) + positive_weights.y * fetch(2) + positive_weights.z * fetch(3);
}
