// What motion blur knows of a pixel, in one texel:
//   xy  how far it gets in half the exposure [px]
//   z   its depth, reversed; 0 for the sky
//   w   length of xy
// The sky has no velocity in the G-buffer: its is that of the camera's turning.
#version 450
#include "lib/motion.glsl"
#include "lib/view.glsl"

layout(binding = 0) uniform sampler2D velocity_map;
layout(binding = 1) uniform sampler2D depth_map;

uniform float half_exposure;  // share of the time between two pictures
uniform float longest;        // [px]

layout(location = 0) out vec4 motion;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(depth_map, at, 0).r;
    vec2 moved = texelFetch(velocity_map, at, 0).xy;
    if (depth == 0.0) {
        vec2 now_ndc = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
        vec3 before = (view.previous_from_world * vec4(view_ray(gl_FragCoord.xy), 0.0)).xyw;
        moved = 0.5 * (now_ndc - before.xy / max(before.z, 1e-6));
    }
    vec2 reach = bounded_motion(moved * view.size.xy * half_exposure, longest);
    motion = vec4(reach, depth, length(reach));
}
