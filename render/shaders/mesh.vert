// Every mesh instance, or the evaluation stage of tessellated ones, for the G-buffer and for the passes that shade while
// drawing. Definitions of lib/mesh_vertex.glsl, and
//   VELOCITY  also the position in the previous frame
//   DEFORMED  with VELOCITY: vertices also move in mesh space
//   OBJECT_LIGHTS  also the index of the instance
//   TRANSMISSION  also the scale of the instance
//   CLIPPED  clipped by view.clip_plane
// Additions of single effects are called by hook_vertex() (render/material/surface_hooks.h).
// Techniques: shade.passthrough-cube
#version 450
#include "lib/material_record.glsl"
#include "lib/mesh_vertex.glsl"
#include "lib/previous_vertex.glsl"
#include "lib/view.glsl"

layout(location = 0) out vec3 normal_ws;   // not normalized
layout(location = 1) out vec4 tangent_ws;  // w: sign of the bitangent
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out uvec2 material_and_flags;
#ifdef MAP_LAYERS
layout(location = 7) flat out vec4 map_layers;
#endif
#ifdef VELOCITY
layout(location = 5) out vec3 previous_clip;  // clip x, y, w
#endif
#ifdef OBJECT_LIGHTS
layout(location = 6) flat out uint object;
#endif
#ifdef TRANSMISSION
layout(location = 9) flat out float scale;  // mean of the axes
#endif
#ifdef CLIPPED
out float gl_ClipDistance[1];
#endif
#include "generated/vertex_hooks.glsl"
invariant gl_Position;  // passes that redraw the nearest surface test for equal depth

void main() {
    gl_Position = view.clip_from_world * vec4(vertex_ws(), 1.0);
#ifdef CLIPPED
    gl_ClipDistance[0] = dot(view.clip_plane, vec4(vertex_ws(), 1.0));
#endif
    normal_ws = vertex_normal_ws();
    vec3 t = vec3(dot(world_row0.xyz, tangent_ms.xyz), dot(world_row1.xyz, tangent_ms.xyz), dot(world_row2.xyz, tangent_ms.xyz));
    hook_vertex(t, normal_ws);
    tangent_ws = vec4(t * inversesqrt(max(dot(t, t), 1e-30)), tangent_ms.w * vertex_side());
    uv = vec4(first_uv, second_uv);
    vertex_color = color;
    material_and_flags = instance.xy;
#ifdef MAP_LAYERS
    map_layers = map_layers_of(instance.x);
#endif
#ifdef OBJECT_LIGHTS
    object = instance.z;
#endif
#ifdef TRANSMISSION
    scale = pow(abs(dot(world_row0.xyz, cross(world_row1.xyz, world_row2.xyz))), 1.0 / 3.0);
#endif

#ifdef VELOCITY
    previous_clip = (view.previous_clip_from_world * vec4(previous_vertex_ws(), 1.0)).xyw;
#endif
}
