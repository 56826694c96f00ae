// Convolves the image with the motion of each point due to the camera (post.motion-blur-camera-psf).
#version 450
#include "lib/motion.glsl"
#include "lib/noise.glsl"
#include "lib/view.glsl"
#include "fullscreen_gpu.h"
#include "motion_modes_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D radiance;
layout(binding = kCameraMotionDepthUnit) uniform sampler2D depth_map;

uniform float half_exposure;  // fraction of the frame time
uniform float longest;        // [px]
uniform int samples;

layout(location = 0) out vec4 blurred;

const float kStill = 0.02;  // [px]; above rounding errors

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(depth_map, pixel, 0).r;
    vec2 now_ndc = gl_FragCoord.xy * view.size.zw * 2.0 - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    // The sky is at infinity: w = 0.
    vec4 point = depth > 0.0 ? vec4(world_position(gl_FragCoord.xy, depth), 1.0) : vec4(view_ray(gl_FragCoord.xy), 0.0);
    vec3 previous_clip = (view.previous_clip_from_world * point).xyw;
    vec2 moved = 0.5 * (now_ndc - previous_clip.xy / max(previous_clip.z, 1e-6)) * view.size.xy;
    vec2 motion = bounded_motion(half_exposure * moved, longest);
    blurred = texelFetch(radiance, pixel, 0);
    if (dot(motion, motion) > kStill * kStill) {
        blurred.rgb = mean_along(radiance, gl_FragCoord.xy, motion, samples, pixel_noise(gl_FragCoord.xy));
    }
}
