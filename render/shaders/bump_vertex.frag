// A pixel of a surface whose vertices bump_vertex.vert has prepared: one normal of the map, one product with each
// light's direction and one with the halfway vector. Surfaces with shading models other than Blinn and Phong have no
// bumps. Definition SINGLE_LIGHTS: lib/single_lights.glsl.
// Techniques: bump.vertex-light-space, env.normalise-cube
#version 450
#include "lib/lighting.glsl"
#define LIT_AT_VERTICES
#include "lib/material.glsl"
#include "lib/light_at.glsl"
#include "lib/single_lights.glsl"
#include "lib/normalization.glsl"

layout(location = 0) INTERPOLATED in vec3 diffuse;
layout(location = 1) INTERPOLATED in vec3 specular;
layout(location = 8) INTERPOLATED in vec4 light_ts[SINGLE_LIGHTS];
layout(location = 12) INTERPOLATED in vec3 halfway_ts[SINGLE_LIGHTS];
layout(location = 16) INTERPOLATED in vec3 irradiance[SINGLE_LIGHTS];

layout(location = 0) out vec4 radiance;

// How much of light at this cosine to the mesh is left: Material::bump_shadow.
float unshadowed_part(float cosine) {
#ifdef BUMP_GATE
    return smooth_fade(2.0, cosine);
#elif defined(BUMP_SMOOTH)
    return smooth_fade(3.0, cosine);
#elif defined(BUMP_RAMP)
    return smooth_fade(1.0, cosine);
#else
    return 1.0;
#endif
}

void main() {
    vec3 n = vec3(0.0, 0.0, 1.0);
#ifdef NORMAL_MAP
    n = tangent_normal(MAP_TEXEL(NORMAL_MAP, kNormalSlot).xyz);
    n.xy *= material_texel(1).w;
    n = unit_vector(n);
#endif
    vec3 albedo = material_texel(0).rgb;
#ifdef VERTEX_COLOR
    albedo *= max(vertex_color.rgb, 0.0);
#endif
    vec4 shine = block_texel(material_and_flags.x, kClassicBlock, 0);
    float exponent = blinn_exponent(material_and_flags.y >> 8, abs(shine.a));
    mat2x3 light = mat2x3(diffuse, specular);
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        vec3 l = unit_vector(light_ts[k].xyz);
        vec4 of_one = lit(dot(n, l), dot(n, unit_vector(halfway_ts[k])), exponent);
        float fade = mix(1.0, 1.0 / max(dot(light_ts[k].xyz, light_ts[k].xyz), 1e-12), light_ts[k].w);
        vec3 arriving = irradiance[k] / kPi * (fade * unshadowed_part(l.z));
        light[0] += arriving * albedo * of_one.y;
        light[1] += arriving * shine.rgb * of_one.z;
    }
    radiance = vec4(storable(light[0] * color_over_light() + light[1] + surface_emission()), 1.0);
}
