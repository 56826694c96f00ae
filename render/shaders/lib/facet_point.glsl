// Points of the triangle of a geometry shader, to be lit. Include first; it includes lib/facet.glsl.
#define UNMASKED  // shadow masks are in screen space
#include "lib/lighting.glsl"
#include "lib/material_maps.glsl"
#include "lib/light_at.glsl"
#include "lib/facet.glsl"

// Corners and midpoints in (s, t), around the triangle.
const vec2 kSixPoints[6] = vec2[](
    vec2(0.0, 0.0), vec2(0.5, 0.0), vec2(1.0, 0.0), vec2(0.5, 0.5), vec2(0.0, 1.0), vec2(0.0, 0.5));

// Unit; used instead of vertex normals that cancel.
vec3 face_normal_ws() {
    vec3 n = cross(corner_ws[1] - corner_ws[0], corner_ws[2] - corner_ws[0]);
    return n * ((corner_instance[0].y & 1u) != 0u ? -1.0 : 1.0) * inversesqrt(max(dot(n, n), 1e-30));
}

// The weighted position, color and normalized normal.
MeshPoint mesh_point(vec2 at) {
    vec3 w = vec3(1.0 - at.x - at.y, at);
    vec3 n = w.x * corner_normal_ws[0] + w.y * corner_normal_ws[1] + w.z * corner_normal_ws[2];
    float n2 = dot(n, n);
    return MeshPoint(
        w.x * corner_ws[0] + w.y * corner_ws[1] + w.z * corner_ws[2],
        n2 > 1e-12 ? n * inversesqrt(n2) : face_normal_ws(),
        w.x * corner_color[0] + w.y * corner_color[1] + w.z * corner_color[2],
        corner_instance[0].xy, corner_instance[0].z);
}
