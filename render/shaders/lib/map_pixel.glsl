// A pixel of a surface that lib/map_vertex.glsl has prepared. Include first.
#define LIT_AT_VERTICES
#include "lib/material.glsl"
#include "lib/radiance.glsl"
#include "highlight_gpu.h"

layout(binding = kHighlightMapsUnit) uniform sampler2DArray highlight_maps;

layout(location = 0) INTERPOLATED in vec3 diffuse;
layout(location = 1) INTERPOLATED in vec3 specular;
layout(location = 6) flat in float highlight_layer;
layout(location = 8) INTERPOLATED in vec3 map_at[SINGLE_LIGHTS];  // in the unit disc; z: N.L
layout(location = 16) INTERPOLATED in vec3 map_factor[SINGLE_LIGHTS];
#ifdef BLINN_DIFFUSE
layout(location = 12) INTERPOLATED in vec2 diffuse_at[SINGLE_LIGHTS];
layout(location = 20) INTERPOLATED in vec3 diffuse_factor[SINGLE_LIGHTS];
#endif

const float kDiffuseLayer = 0.0;  // of exponent 1: sqrt(1 - x^2 - y^2)

layout(location = 0) out vec4 radiance;

vec3 map_texel(vec2 at, float layer) {
    return texture(highlight_maps, vec3(0.5 + 0.5 * at, layer)).rgb;
}

// `tinted`: still to be multiplied by the base color map and the dress.
vec4 map_radiance(vec3 tinted, vec3 highlights) {
    return vec4(storable(tinted * color_over_light() + highlights + surface_emission()), 1.0);
}
