// What geometry shaders share that prepare something once per triangle for its pixels. They define outputs and main(),
// which calls put_corner() before each EmitVertex().
#define UNMASKED  // shadow masks are in screen space
#include "lib/lighting.glsl"
#include "lib/material_maps.glsl"
#include "lib/light_at.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

layout(location = 0) in vec3 corner_ws[];
layout(location = 1) in vec3 corner_normal_ws[];
layout(location = 2) in vec4 corner_uv[];
layout(location = 3) in vec4 corner_color[];
layout(location = 4) in uvec3 corner_instance[];  // material, flags, object

layout(location = 0) out vec2 st;  // p(s, t) = p0 + s (p1 - p0) + t (p2 - p0)
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out uvec2 material_and_flags;
#ifdef MAP_LAYERS
layout(location = 7) flat out vec4 map_layers;
#endif
invariant gl_Position;  // the depth must equal that of depth_first.frag

// Corners and midpoints in (s, t), around the triangle.
const vec2 kSixPoints[6] = vec2[](
    vec2(0.0, 0.0), vec2(0.5, 0.0), vec2(1.0, 0.0), vec2(0.5, 0.5), vec2(0.0, 1.0), vec2(0.0, 0.5));

// Unit; stands in for normals that cancel.
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
        w.x * corner_color[0].rgb + w.y * corner_color[1].rgb + w.z * corner_color[2].rgb,
        corner_instance[0].xy, corner_instance[0].z);
}

void put_corner(int i) {
    gl_Position = gl_in[i].gl_Position;
    st = vec2(i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0);
    uv = corner_uv[i];
    vertex_color = corner_color[i];
    material_and_flags = corner_instance[i].xy;
#ifdef MAP_LAYERS
    map_layers = map_layers_of(corner_instance[i].x);
#endif
}
