// Prepares a second-order Taylor series of the light about the centroid of a triangle (fakephong.taylor; Bishop and
// Weimer, "Fast Phong Shading", 1986). The series of L.N / |N| is linear in L: it is L times the series of N / |N|,
// which all lights share; highlights use H instead of L. Lights and viewer count as infinitely far: L and H are
// evaluated at the centroid. Definition SINGLE_LIGHTS: lib/single_lights.glsl.
// Techniques: fakephong.taylor
#version 450
#include "lib/facet_point.glsl"
#include "lib/single_lights.glsl"

layout(location = 1) out vec3 diffuse;   // of all other light, at vertices
layout(location = 5) out vec3 specular;
layout(location = 6) flat out vec3 to_camera;
layout(location = 8) flat out vec3 normal_series[6];  // n, n_s, n_t, n_ss, n_st, n_tt; zero if the normals cancel
layout(location = 14) flat out vec4 light_vector[SINGLE_LIGHTS];  // L, 1 / |L + V|
layout(location = 22) flat out vec3 irradiance[SINGLE_LIGHTS];

vec3[6] series_of(vec3 a, vec3 b, vec3 c) {  // of (a s + b t + c) / |a s + b t + c| about s = t = 0
    float q = dot(c, c);
    if (q < 1e-12) {
        return vec3[](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    }
    float q_s = 2.0 * dot(a, c);
    float q_t = 2.0 * dot(b, c);
    float q1 = inversesqrt(q);
    float q3 = q1 / q;
    float q5 = q3 / q;
    return vec3[](
        c * q1,
        a * q1 - 0.5 * q_s * q3 * c,
        b * q1 - 0.5 * q_t * q3 * c,
        0.75 * q_s * q_s * q5 * c - q_s * q3 * a - dot(a, a) * q3 * c,
        0.75 * q_s * q_t * q5 * c - 0.5 * q3 * (q_t * a + q_s * b) - dot(a, b) * q3 * c,
        0.75 * q_t * q_t * q5 * c - q_t * q3 * b - dot(b, b) * q3 * c);
}

void main() {
    vec3 series[6] = series_of(
        corner_normal_ws[1] - corner_normal_ws[0], corner_normal_ws[2] - corner_normal_ws[0],
        (corner_normal_ws[0] + corner_normal_ws[1] + corner_normal_ws[2]) / 3.0);
    LitPoint center = lit_point(mesh_point(vec2(1.0 / 3.0)));
    vec3 viewer = center.reflector.to_camera;
    float side = dot(center.reflector.normal, series[0]) < 0.0 ? -1.0 : 1.0;  // for double-sided surfaces
    vec4 vectors[SINGLE_LIGHTS];
    vec3 irradiances[SINGLE_LIGHTS];
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        vectors[k] = vec4(0.0);
        irradiances[k] = vec3(0.0);
        if (k < center.single) {
            Incoming light = single_light(center, k);
            vec3 sum = light.to_light + viewer;
            vectors[k] = vec4(light.to_light, inversesqrt(max(dot(sum, sum), 1e-8)));
            irradiances[k] = light.irradiance;
        }
    }
    for (int i = 0; i < 3; ++i) {
        LitPoint corner = lit_point(mesh_point(kSixPoints[2 * i]));
        Reflected light = light_from(corner, corner.single, corner.single, kEveryLight);
        put_corner(i);
        diffuse = light.diffuse;
        specular = light.specular;
        to_camera = viewer;
        for (int j = 0; j < 6; ++j) {
            normal_series[j] = side * series[j];
        }
        light_vector = vectors;
        irradiance = irradiances;
        EmitVertex();
    }
    EndPrimitive();
}
