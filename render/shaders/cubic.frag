// The cubic through the light of ten points of a triangle (fakephong.cubic), as the sum of its Lagrange basis in
// barycentric coordinates.
// Techniques: fakephong.cubic
#version 450
#define FACET_SAMPLES 10
#include "lib/sampled_light.glsl"

void main() {
    vec3 w = vec3(1.0 - st.x - st.y, st);
    vec3 v = 3.0 * w - 1.0;
    vec3 corner = 0.5 * w * v * (v - 1.0);
    vec3 edge = 4.5 * w * w.yzx;  // ab, bc, ca
    radiance = facet_radiance(
        corner.x * light_sample(0) + corner.y * light_sample(1) + corner.z * light_sample(2)
        + edge.x * (v.x * light_sample(3) + v.y * light_sample(4))
        + edge.y * (v.y * light_sample(5) + v.z * light_sample(6))
        + edge.z * (v.z * light_sample(7) + v.x * light_sample(8))
        + 27.0 * w.x * w.y * w.z * light_sample(9));
}
