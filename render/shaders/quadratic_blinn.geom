// Coordinates in a Blinn map at corners and midpoints of each triangle, for each light (fakephong.quadratic-blinn). All
// other light is evaluated at the corners. Definitions SINGLE_LIGHTS, WORST_AXIS and BLINN_DIFFUSE:
// lib/single_lights.glsl, lib/highlight_map.glsl, lib/map_lights.glsl.
// Techniques: fakephong.quadratic-blinn
#version 450
#include "lib/facet_point.glsl"
#include "lib/single_lights.glsl"
#include "lib/highlight_map.glsl"
#include "highlight_gpu.h"

layout(binding = kHighlightLayersUnit) uniform usamplerBuffer highlight_layers;  // by material

layout(location = 1) out vec3 diffuse;
layout(location = 5) out vec3 specular;
layout(location = 6) flat out float highlight_layer;
layout(location = 8) out vec4 map_factor[SINGLE_LIGHTS];  // w: N.L
// 16 bits per coordinate, six pairs per light.
layout(location = 16) flat out uvec4 map_at[(6 * SINGLE_LIGHTS + 3) / 4];
#ifdef BLINN_DIFFUSE
layout(location = 12) out vec3 diffuse_factor[SINGLE_LIGHTS];
layout(location = 22) flat out uvec4 diffuse_at[(6 * SINGLE_LIGHTS + 3) / 4];
#endif

void main() {
    uint at[6 * SINGLE_LIGHTS + 2];
    vec4 factors[3 * SINGLE_LIGHTS];
#ifdef BLINN_DIFFUSE
    uint at_diffuse[6 * SINGLE_LIGHTS + 2];
    vec3 diffuse_factors[3 * SINGLE_LIGHTS];
    at_diffuse[6 * SINGLE_LIGHTS] = 0u;
    at_diffuse[6 * SINGLE_LIGHTS + 1] = 0u;
#endif
    vec3 corner_diffuse[3];
    vec3 corner_specular[3];
    at[6 * SINGLE_LIGHTS] = 0u;  // pads the last vector
    at[6 * SINGLE_LIGHTS + 1] = 0u;
    for (int i = 0; i < 6; ++i) {
        LitPoint p = lit_point(mesh_point(kSixPoints[i]));
        for (int k = 0; k < SINGLE_LIGHTS; ++k) {
            vec2 map_point = vec2(1.0, 0.0);
            vec2 diffuse_point = vec2(1.0, 0.0);
            vec3 albedo = vec3(0.0);
            vec4 factor = vec4(0.0);
            if (k < p.single) {
                Incoming light = single_light(p, k);
                diffuse_point = plane_coordinates(p.reflector.normal, light.to_light);
                albedo = light.irradiance / kPi * p.reflector.diffuse;
                map_point = blinn_coordinates(p.reflector.normal, light.to_light, p.reflector.to_camera);
                factor = vec4(
                    light.irradiance / kPi * p.reflector.specular_0, dot(p.reflector.normal, light.to_light));
            }
            at[6 * k + i] = packSnorm2x16(map_point);
            if (i % 2 == 0) {
                factors[3 * k + i / 2] = factor;
            }
#ifdef BLINN_DIFFUSE
            at_diffuse[6 * k + i] = packSnorm2x16(diffuse_point);
            if (i % 2 == 0) {
                diffuse_factors[3 * k + i / 2] = albedo;
            }
#endif
        }
        if (i % 2 == 0) {
#ifdef BLINN_DIFFUSE
            Reflected light = light_from(p, p.single, p.single, kEveryLight);
#else
            Reflected light = light_from(p, 0, p.single, kEveryLight);
#endif
            corner_diffuse[i / 2] = light.diffuse;
            corner_specular[i / 2] = light.specular;
        }
    }
    for (int i = 0; i < 3; ++i) {
        put_corner(i);
        diffuse = corner_diffuse[i];
        specular = corner_specular[i];
        highlight_layer = float(texelFetch(highlight_layers, int(corner_instance[0].x)).x);
        for (int k = 0; k < SINGLE_LIGHTS; ++k) {
            map_factor[k] = factors[3 * k + i];
        }
        for (int k = 0; k < map_at.length(); ++k) {
            map_at[k] = uvec4(at[4 * k], at[4 * k + 1], at[4 * k + 2], at[4 * k + 3]);
#ifdef BLINN_DIFFUSE
            diffuse_at[k] =
                uvec4(at_diffuse[4 * k], at_diffuse[4 * k + 1], at_diffuse[4 * k + 2], at_diffuse[4 * k + 3]);
#endif
        }
#ifdef BLINN_DIFFUSE
        for (int k = 0; k < SINGLE_LIGHTS; ++k) {
            diffuse_factor[k] = diffuse_factors[3 * k + i];
        }
#endif
        EmitVertex();
    }
    EndPrimitive();
}
