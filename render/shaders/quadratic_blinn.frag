// Highlights by one fetch per light from a Blinn map, at quadratically interpolated coordinates
// (fakephong.quadratic-blinn). Definitions SINGLE_LIGHTS and BLINN_DIFFUSE: lib/single_lights.glsl,
// lib/map_lights.glsl.
// Techniques: fakephong.quadratic-blinn
#version 450
#include "lib/facet_pixel.glsl"
#include "highlight_gpu.h"

layout(binding = kHighlightMapsUnit) uniform sampler2DArray highlight_maps;

layout(location = 1) INTERPOLATED in vec3 diffuse;
layout(location = 5) INTERPOLATED in vec3 specular;
layout(location = 6) flat in float highlight_layer;
layout(location = 8) INTERPOLATED in vec4 map_factor[SINGLE_LIGHTS];  // w: N.L
layout(location = 16) flat in uvec4 map_at[(6 * SINGLE_LIGHTS + 3) / 4];
#ifdef BLINN_DIFFUSE
layout(location = 12) INTERPOLATED in vec3 diffuse_factor[SINGLE_LIGHTS];
layout(location = 22) flat in uvec4 diffuse_at[(6 * SINGLE_LIGHTS + 3) / 4];

const float kDiffuseLayer = 0.0;  // exponent 1: sqrt(1 - x^2 - y^2)
#endif

float map_texel(vec2 at, float layer) {
    return texture(highlight_maps, vec3(0.5 + 0.5 * at, layer)).r;
}

void main() {
    float basis[6] = quadratic_basis(st);
    vec3 tinted = diffuse;
    vec3 highlights = specular;
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        vec2 at = vec2(0.0);
        for (int i = 0; i < 6; ++i) {
            int pair = 6 * k + i;
            at += basis[i] * unpackSnorm2x16(map_at[pair / 4][pair % 4]);
        }
        highlights += map_factor[k].w > 0.0 ? map_factor[k].rgb * map_texel(at, highlight_layer) : vec3(0.0);
#ifdef BLINN_DIFFUSE
        vec2 at_diffuse = vec2(0.0);
        for (int i = 0; i < 6; ++i) {
            int pair = 6 * k + i;
            at_diffuse += basis[i] * unpackSnorm2x16(diffuse_at[pair / 4][pair % 4]);
        }
        tinted += diffuse_factor[k] * map_texel(at_diffuse, kDiffuseLayer);
#endif
    }
    radiance = facet_radiance(mat2x3(tinted, highlights));
}
