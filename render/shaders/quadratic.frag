// The quadratic through the light of the corners and midpoints of a triangle (fakephong.quadratic, equation 4.2).
#version 450
#define FACET_SAMPLES 6
#include "lib/sampled_light.glsl"

void main() {
    float basis[6] = quadratic_basis(st);
    mat2x3 light = basis[0] * light_sample(0);
    for (int i = 1; i < 6; ++i) {
        light += basis[i] * light_sample(i);
    }
    radiance = facet_radiance(light);
}
