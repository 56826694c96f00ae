// Input of motion blur for a pixel, in one texel:
//   xy  motion in half the exposure [px]
//   z   its depth, reversed; 0 for the sky
//   w   length of xy
#version 450
#include "lib/motion.glsl"
#include "lib/view.glsl"
#include "motion_blur_gpu.h"

layout(binding = kPackVelocityUnit) uniform sampler2D velocity_map;
layout(binding = kPackDepthUnit) uniform sampler2D depth_map;

uniform float half_exposure;  // fraction of the frame time
uniform float longest;        // [px]

layout(location = 0) out vec4 motion;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(depth_map, at, 0).r;
    vec2 moved = texelFetch(velocity_map, at, 0).xy;
    vec2 half_motion = bounded_motion(moved * view.size.xy * half_exposure, longest);
    motion = vec4(half_motion, depth, length(half_motion));
}
