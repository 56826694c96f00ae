// Light between the points of a triangle that lib/facet_samples.glsl has lit. Include first.
#define LIT_AT_VERTICES
#include "lib/material.glsl"
#include "lib/radiance.glsl"

layout(location = 0) in vec2 st;
layout(location = 9) flat in vec3 sampled[2 * FACET_SAMPLES];  // diffuse, specular of each point

layout(location = 0) out vec4 radiance;

// Columns: diffuse light, still to be multiplied by the base color map, and specular light.
mat2x3 light_sample(int i) {
    return mat2x3(sampled[2 * i], sampled[2 * i + 1]);
}

// A polynomial may undershoot: no light is negative.
vec4 sampled_radiance(mat2x3 light) {
    vec3 reflected = max(light[0] * base_color_texel().rgb + light[1], 0.0);
    return vec4(storable(reflected + surface_emission()), 1.0);
}
