// The mean of the last frames (post.motion-blur-accumulation). Sums differences from the newest, so that the mean of
// equal frames is bit-identical.
#version 450
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2DArray frames;

uniform int newest;  // layer
uniform int count;   // of frames, including the newest, in the layers of the ring before it
uniform int window;  // layers of the ring

layout(location = 0) out vec4 mean;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 last = texelFetch(frames, ivec3(at, newest), 0);
    vec4 sum = vec4(0.0);
    for (int i = 1; i < count; ++i) {
        sum += texelFetch(frames, ivec3(at, (newest - i + window) % window), 0) - last;
    }
    mean = last + sum / float(count);
}
