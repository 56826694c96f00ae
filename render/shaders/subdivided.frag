// Light of the corners and midpoints of a triangle, linear in each of its quarters (fakephong.gouraud-subdivided).
// Techniques: fakephong.barycentric, fakephong.gouraud-subdivided
#version 450
#define FACET_SAMPLES 6
#include "lib/sampled_light.glsl"

mat2x3 quarter(int a, int b, int c, vec2 at) {
    mat2x3 first = light_sample(a);
    return first + at.x * (light_sample(b) - first) + at.y * (light_sample(c) - first);
}

void main() {
    vec2 at = 2.0 * st;
    mat2x3 light;
    if (at.x > 1.0) {
        light = quarter(1, 2, 3, at - vec2(1.0, 0.0));
    } else if (at.y > 1.0) {
        light = quarter(5, 3, 4, at - vec2(0.0, 1.0));
    } else if (at.x + at.y > 1.0) {
        light = quarter(3, 5, 1, 1.0 - at);
    } else {
        light = quarter(0, 1, 5, at);
    }
    radiance = facet_radiance(light);
}
