// Light between the points of a triangle that lib/facet_samples.glsl has lit. Include first.
#include "lib/facet_pixel.glsl"

layout(location = 9) flat in vec3 sampled[2 * FACET_SAMPLES];  // diffuse, specular of each point

// Columns: diffuse and specular light.
mat2x3 light_sample(int i) {
    return mat2x3(sampled[2 * i], sampled[2 * i + 1]);
}
