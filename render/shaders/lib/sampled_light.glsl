// Light between the points of a triangle that lib/facet_samples.glsl has lit. Include first.
#include "lib/facet_pixel.glsl"

layout(location = 9) flat in vec3 sampled[2 * FACET_SAMPLES];  // diffuse, specular of each point

// Columns: diffuse and specular light.
mat2x3 light_sample(int i) {
    return mat2x3(sampled[2 * i], sampled[2 * i + 1]);
}

#if FACET_SAMPLES == 6
// The quadratic through them (equation 4.2).
mat2x3 quadratic_light(vec2 at) {
    float basis[6] = quadratic_basis(at);
    mat2x3 light = basis[0] * light_sample(0);
    for (int i = 1; i < 6; ++i) {
        light += basis[i] * light_sample(i);
    }
    return light;
}
#endif
