// Where nothing is, all is infinitely far away: it moves as the camera turns.
#version 450
#include "lib/velocity.glsl"
#include "lib/view.glsl"

layout(location = 0) out vec2 velocity;

void main() {
    vec2 now = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    vec3 before = (view.previous_from_world * vec4(view_ray(gl_FragCoord.xy), 0.0)).xyw;
    velocity = velocity_from(now, before);
}
