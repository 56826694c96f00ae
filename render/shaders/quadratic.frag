// The quadratic through the light of the corners and midpoints of a triangle (fakephong.quadratic, equation 4.2), as
// the sum of its Lagrange basis in barycentric coordinates: a corner's is a (2 a - 1), a midpoint's 4 a b.
#version 450
#define FACET_SAMPLES 6
#include "lib/sampled_light.glsl"

void main() {
    float a = 1.0 - st.x - st.y;
    float b = st.x;
    float c = st.y;
    radiance = sampled_radiance(
        a * (2.0 * a - 1.0) * light_sample(0) + b * (2.0 * b - 1.0) * light_sample(2)
        + c * (2.0 * c - 1.0) * light_sample(4)
        + 4.0 * (a * b * light_sample(1) + b * c * light_sample(3) + c * a * light_sample(5)));
}
