// Position of a vertex of lib/mesh_vertex.glsl in the previous frame. Definition:
//   DEFORMED  vertices also move in mesh space

layout(location = 9) in vec4 previous_row0;  // world_from_mesh
layout(location = 10) in vec4 previous_row1;
layout(location = 11) in vec4 previous_row2;
layout(location = 12) in vec3 previous_position_ms;

vec3 previous_vertex_ws() {
#ifdef DEFORMED
    vec4 p = vec4(moved_vertex(previous_position_ms), 1.0);
#else
    vec4 p = vec4(vertex_ms(), 1.0);
#endif
    return vec3(dot(previous_row0, p), dot(previous_row1, p), dot(previous_row2, p));
}
