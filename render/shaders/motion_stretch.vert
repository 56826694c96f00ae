// Stretches a moving object from its previous to its current position: vertices of leading faces are at the current
// one, the others at the previous one (post.motion-blur-stretch). Definitions of lib/mesh_vertex.glsl and
// lib/previous_vertex.glsl.
// Techniques: post.motion-blur-stretch
#version 450
#include "lib/mesh_vertex.glsl"
#include "lib/previous_vertex.glsl"
#include "lib/view.glsl"

uniform int with_camera;  // 1: include the camera's motion

noperspective layout(location = 0) out vec2 motion;  // since the previous frame [px]

// View space of a clip position: right, up, forward [m].
vec3 in_view(vec4 clip) {
    return vec3(clip.x * length(view.ray_right.xyz), clip.y * length(view.ray_up.xyz), clip.w);
}

void main() {
    vec4 now = view.clip_from_world * vec4(vertex_ws(), 1.0);
    vec2 jitter = vec2(view.ray_right.w, view.ray_up.w);
    // Both without the jitter, or both with it.
    vec4 previous = with_camera == 1 ? view.previous_clip_from_world * vec4(previous_vertex_ws(), 1.0)
                                   : view.clip_from_world * vec4(previous_vertex_ws(), 1.0);
    if (with_camera == 1) {
        previous.xy += jitter * previous.w;
    }
    vec3 moved = in_view(now) - in_view(previous);
    vec3 normal_ws = vertex_normal_ws();
    vec3 normal = vec3(
        dot(normal_ws, normalize(view.ray_right.xyz)), dot(normal_ws, normalize(view.ray_up.xyz)),
        dot(normal_ws, view.ray_forward.xyz));
    gl_Position = dot(moved, normal) > 0.0 ? now : previous;
    motion = 0.5 * view.size.xy * (now.xy / max(now.w, 1e-6) - previous.xy / max(previous.w, 1e-6));
#ifndef DEFORMED
    // Static objects are not drawn.
    bool still = world_row0 == previous_row0 && world_row1 == previous_row1 && world_row2 == previous_row2;
    if (still && (with_camera == 0 || dot(moved, moved) < 1e-12)) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
#endif
}
