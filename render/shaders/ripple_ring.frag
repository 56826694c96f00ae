// A spherical shell that bends grazing rays.
#version 450
#include "lib/view.glsl"
#include "gbuffer_gpu.h"

layout(binding = kDepthUnit) uniform sampler2D scene_depth;

uniform vec3 center;       // [m]
uniform float radius;      // [m]
uniform float wavelength;  // [m]
uniform float amplitude;   // [rad]

layout(location = 0) out vec4 shift;  // [px]; alpha: maximum depth to read

// Shift of a pixel [px] when its ray (of the length of view_ray()) changes by `turn`.
vec2 screen_shift(vec3 ray, vec3 turn) {
    float farther = dot(turn, view.ray_forward.xyz);
    vec3 aside = (turn - farther * ray) / (1.0 + farther);
    vec2 ndc = vec2(
        dot(aside, view.ray_right.xyz) / dot(view.ray_right.xyz, view.ray_right.xyz),
        dot(aside, view.ray_up.xyz) / dot(view.ray_up.xyz, view.ray_up.xyz));
    return 0.5 * view.size.xy * ndc;
}

void main() {
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec3 ray = view_ray(gl_FragCoord.xy);
    vec3 along = normalize(ray);
    vec3 to_center = center - view.camera_ws.xyz;
    float path = dot(to_center, along);
    vec3 out_of = path * along - to_center;  // from the center to the ray's nearest point
    float near = length(out_of);

    float s = (near - radius) / wavelength;
    float window = 1.0 - min(s * s, 1.0);
    float wave = sin(6.283185307 * s) * window * window;
    // Surfaces just behind the shell shift little, those far behind it fully.
    float distance = max(dot(to_center, view.ray_forward.xyz), view.camera_ws.w);
    float shell_depth = view.camera_ws.w / distance;
    float behind = clamp(1.0 - depth / shell_depth, 0.0, 1.0);

    float turn = path > 0.0 && near > 0.0 ? amplitude * wave * behind * length(ray) / near : 0.0;
    if (turn == 0.0) {
        discard;  // leaves the depth of other effects
    }
    shift = vec4(screen_shift(ray, turn * out_of), 0.0, shell_depth);
}
