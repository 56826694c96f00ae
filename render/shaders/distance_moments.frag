// The moments of the distance at each pixel.
#version 450
#include "lib/distance_moments.glsl"

layout(location = 0) out vec2 moments;

void main() {
    moments = distance_moments(ivec2(gl_FragCoord.xy));
}
