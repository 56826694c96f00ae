// A moving object stretched between where it was and where it is: points that go ahead of their surface are at its
// new place, the others at its old one (post.motion-blur-stretch). Definitions of lib/mesh_vertex.glsl and
// lib/vertex_before.glsl.
#version 450
#include "lib/mesh_vertex.glsl"
#include "lib/vertex_before.glsl"
#include "lib/view.glsl"

uniform int with_camera;  // 1: the camera's motion stretches, too

noperspective layout(location = 0) out vec2 way;  // of this point since the picture before [px]

// View space of a clip position: how far right, up and ahead [m].
vec3 in_view(vec4 clip) {
    return vec3(clip.x * length(view.ray_right.xyz), clip.y * length(view.ray_up.xyz), clip.w);
}

void main() {
    vec4 now = view.clip_from_world * vec4(vertex_ws(), 1.0);
    vec2 jitter = vec2(view.ray_right.w, view.ray_up.w);
    // Both without the jitter, or both with it.
    vec4 before = with_camera == 1 ? view.previous_from_world * vec4(vertex_before_ws(), 1.0)
                                   : view.clip_from_world * vec4(vertex_before_ws(), 1.0);
    if (with_camera == 1) {
        before.xy += jitter * before.w;
    }
    vec3 moved = in_view(now) - in_view(before);
    vec3 normal_ws = vertex_normal_ws();
    vec3 normal = vec3(
        dot(normal_ws, normalize(view.ray_right.xyz)), dot(normal_ws, normalize(view.ray_up.xyz)),
        dot(normal_ws, view.ray_forward.xyz));
    gl_Position = dot(moved, normal) > 0.0 ? now : before;
    way = 0.5 * view.size.xy * (now.xy / max(now.w, 1e-6) - before.xy / max(before.w, 1e-6));
#ifndef DEFORMED
    // What stands still is no layer: nothing of it is drawn.
    bool still = world_row0 == before_row0 && world_row1 == before_row1 && world_row2 == before_row2;
    if (still && (with_camera == 0 || dot(moved, moved) < 1e-12)) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
#endif
}
