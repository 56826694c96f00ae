// The quadratic through the light of the corners and midpoints of a triangle (fakephong.quadratic, equation 4.2).
// Techniques: fakephong.quadratic
#version 450
#define FACET_SAMPLES 6
#include "lib/sampled_light.glsl"

void main() {
    radiance = facet_radiance(quadratic_light(st));
}
