// The field along which optic-flow motion blur warps, at the vertices. Definitions of lib/mesh_vertex.glsl and
// lib/previous_vertex.glsl.
// Techniques: post.motion-blur-optic-flow
#version 450
#include "lib/mesh_vertex.glsl"
#include "lib/motion.glsl"
#include "lib/previous_vertex.glsl"
#include "lib/view.glsl"

layout(location = 0) out vec3 tail;  // clip x, y, w of the start of the offset that ends here
invariant gl_Position;               // as in mesh.vert

void main() {
    gl_Position = view.clip_from_world * vec4(vertex_ws(), 1.0);
    vec3 offset_ws = flow_offset(vertex_normal_ws(), vertex_ws() - previous_vertex_ws());
    tail = (view.clip_from_world * vec4(vertex_ws() - offset_ws, 1.0)).xyw;
}
