// Vertices of triangles that lib/facet.glsl prepares. Definition HW_MIDPOINTS: also the normals that hw_quadratic.geom
// needs.
#version 450
#include "lib/mesh_vertex.glsl"
#include "lib/view.glsl"

layout(location = 0) out vec3 corner_ws;
layout(location = 1) out vec3 corner_normal_ws;
layout(location = 2) out vec4 corner_uv;
layout(location = 3) out vec4 corner_color;
layout(location = 4) out uvec3 corner_instance;  // material, flags, object
#ifdef HW_MIDPOINTS
layout(location = 5) out vec3 corner_normal_ms;
layout(location = 6) out vec3 corner_scaled_normal;
#endif
invariant gl_Position;

void main() {
    corner_ws = vertex_ws();
    gl_Position = view.clip_from_world * vec4(corner_ws, 1.0);
    corner_normal_ws = vertex_normal_ws();
    corner_uv = vec4(first_uv, second_uv);
    corner_color = color;
    corner_instance = instance.xyz;
#ifdef HW_MIDPOINTS
    corner_normal_ms = normal_ms;
    corner_scaled_normal = vec3(
        dot(world_row0.xyz, normal_ms), dot(world_row1.xyz, normal_ms), dot(world_row2.xyz, normal_ms));
#endif
}
