// The Taylor series that taylor.geom has prepared, and the power of highlights. Definition SINGLE_LIGHTS:
// lib/single_lights.glsl.
// Techniques: fakephong.taylor
#version 450
#include "lib/lighting.glsl"
#include "lib/facet_pixel.glsl"
#include "lib/light_at.glsl"
#include "lib/single_lights.glsl"

layout(location = 1) INTERPOLATED in vec3 diffuse;
layout(location = 5) INTERPOLATED in vec3 specular;
layout(location = 6) flat in vec3 to_camera;
layout(location = 8) flat in vec3 normal_series[6];
layout(location = 14) flat in vec4 light_vector[SINGLE_LIGHTS];
layout(location = 22) flat in vec3 irradiance[SINGLE_LIGHTS];

void main() {
    vec2 d = st - 1.0 / 3.0;
    vec3 normal = normal_series[0] + d.x * normal_series[1] + d.y * normal_series[2]
                  + 0.5 * (d.x * d.x * normal_series[3] + d.y * d.y * normal_series[5]) + d.x * d.y * normal_series[4];
    vec3 albedo = material_texel(0).rgb;
#ifdef VERTEX_COLOR
    albedo *= max(vertex_color.rgb, 0.0);
#endif
    vec4 shine = block_texel(material_and_flags.x, kClassicBlock, 0);
    float exponent = blinn_exponent(material_and_flags.y >> 8, abs(shine.a));
    mat2x3 light = mat2x3(diffuse, specular);
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        vec4 l = light_vector[k];
        float n_l = dot(normal, l.xyz);
        float n_h = (n_l + dot(normal, to_camera)) * l.w;
        vec4 of_one = lit(n_l, min(n_h, 1.0), exponent);
        light[0] += irradiance[k] / kPi * albedo * min(of_one.y, 1.0);
        light[1] += irradiance[k] / kPi * shine.rgb * of_one.z;
    }
    radiance = facet_radiance(light);
}
