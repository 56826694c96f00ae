// Where a vertex of lib/mesh_vertex.glsl was the moment before. Definition:
//   DEFORMED  points moved in the mesh's own space, too

layout(location = 9) in vec4 before_row0;  // world_from_mesh
layout(location = 10) in vec4 before_row1;
layout(location = 11) in vec4 before_row2;
layout(location = 12) in vec3 position_before_ms;

vec3 vertex_before_ws() {
#ifdef DEFORMED
    vec4 p = vec4(moved_vertex(position_before_ms), 1.0);
#else
    vec4 p = vec4(vertex_ms(), 1.0);
#endif
    return vec3(dot(before_row0, p), dot(before_row1, p), dot(before_row2, p));
}
