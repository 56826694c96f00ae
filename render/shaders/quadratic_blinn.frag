// Highlights by one fetch per light from a Blinn map, where quadratic coordinates lead (fakephong.quadratic-blinn).
// Definition SINGLE_LIGHTS: lib/single_lights.glsl.
#version 450
#include "lib/facet_pixel.glsl"

layout(binding = 5) uniform sampler2DArray highlight_maps;

layout(location = 1) in vec3 diffuse;
layout(location = 5) in vec3 specular;
layout(location = 6) flat in float highlight_layer;
layout(location = 8) in vec4 map_factor[SINGLE_LIGHTS];  // w: N.L
layout(location = 16) flat in uvec4 map_at[(6 * SINGLE_LIGHTS + 3) / 4];

void main() {
    float basis[6] = quadratic_basis(st);
    vec3 highlights = specular;
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        vec2 at = vec2(0.0);
        for (int i = 0; i < 6; ++i) {
            int pair = 6 * k + i;
            at += basis[i] * unpackSnorm2x16(map_at[pair / 4][pair % 4]);
        }
        float highlight = texture(highlight_maps, vec3(0.5 + 0.5 * at, highlight_layer)).r;
        highlights += map_factor[k].w > 0.0 ? map_factor[k].rgb * highlight : vec3(0.0);
    }
    radiance = facet_radiance(mat2x3(diffuse, highlights));
}
