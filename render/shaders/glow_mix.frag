// The picture less what each pixel gives away, and what the lens makes of it. Definition ANY_SIZE of
// lib/pyramid_up.glsl.
#version 450
#include "lib/pyramid_up.glsl"

layout(binding = 0) uniform sampler2D scene_radiance;
layout(binding = 1) uniform sampler2D glow;  // alpha: share of its light that a texel took

uniform float strength;
uniform float gain;  // strength over the sum of all weights in `glow`

layout(location = 0) out vec4 radiance;

void main() {
    vec4 scene = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
    vec4 scattered = enlarged(glow);
    radiance = vec4(scene.rgb * (1.0 - strength * scattered.a) + gain * scattered.rgb, scene.a);
}
