// Adds a level of the pyramid, with all that was added to it, to the next larger one. Definition ANY_SIZE of
// lib/pyramid_up.glsl.
#version 450
#include "lib/pyramid_up.glsl"

layout(binding = 0) uniform sampler2D smaller;

uniform float gain;

layout(location = 0) out vec4 added;

void main() {
    added = vec4(gain * enlarged(smaller).rgb, 0.0);
}
