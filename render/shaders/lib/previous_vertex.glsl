// Position of a vertex of lib/mesh_vertex.glsl in the previous frame. Definition:
//   DEFORMED  vertices also move in mesh space

#include "lib/vertex_input.glsl"

INSTANCE_INPUT(9, vec4, previous_row0);  // world_from_mesh
INSTANCE_INPUT(10, vec4, previous_row1);
INSTANCE_INPUT(11, vec4, previous_row2);
VERTEX_INPUT(12, vec3, previous_position_ms);

vec3 previous_vertex_ws() {
#ifdef DEFORMED
    vec4 p = vec4(moved_vertex(previous_position_ms), 1.0);
#else
    vec4 p = vec4(vertex_ms(), 1.0);
#endif
    return vec3(dot(previous_row0, p), dot(previous_row1, p), dot(previous_row2, p));
}
