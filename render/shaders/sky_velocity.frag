// Velocity of the background: at infinity, it moves only with the camera's rotation.
#version 450
#include "lib/velocity.glsl"
#include "lib/view.glsl"

layout(location = 0) out vec2 velocity;

void main() {
    vec2 now = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    vec3 previous_clip = (view.previous_clip_from_world * vec4(view_ray(gl_FragCoord.xy), 0.0)).xyw;
    velocity = velocity_from(now, previous_clip, view.size.xy);
}
