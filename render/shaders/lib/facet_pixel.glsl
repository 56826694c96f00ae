// A pixel of a triangle that lib/facet.glsl has prepared. Include first, or after lib/lighting.glsl.
#define LIT_AT_VERTICES
#include "lib/material.glsl"
#include "lib/radiance.glsl"

layout(location = 0) INTERPOLATED in vec2 st;

layout(location = 0) out vec4 radiance;

// The basis of quadratics through the values at corners and midpoints, around the triangle: a (2 a - 1) for corners, in
// barycentric coordinates, 4 a b for midpoints.
float[6] quadratic_basis(vec2 at) {
    float a = 1.0 - at.x - at.y;
    float b = at.x;
    float c = at.y;
    return float[](
        a * (2.0 * a - 1.0), 4.0 * a * b, b * (2.0 * b - 1.0), 4.0 * b * c, c * (2.0 * c - 1.0), 4.0 * c * a);
}

// Columns: diffuse light, still to be multiplied by the base color map and the dress, and specular light. A polynomial may
// undershoot, so negative light is clamped.
vec4 facet_radiance(mat2x3 light) {
    vec3 reflected = max(light[0] * color_over_light() + light[1], 0.0);
    return vec4(storable(reflected + surface_emission()), 1.0);
}
