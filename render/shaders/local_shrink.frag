// Downsamples the widest blur: each texel is the mean of the four around its center.
#version 450
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D source;

uniform vec2 texel;  // of the target, in texture coordinates

layout(location = 0) out vec4 shrunk;

void main() {
    shrunk = texture(source, gl_FragCoord.xy * texel).wwww;
}
