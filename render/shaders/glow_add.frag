// Adds a half-resolution mask to the image.
#version 450
#include "lib/radiance.glsl"
#include "fullscreen_gpu.h"
#include "glow_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(binding = kGlowUnit) uniform sampler2D mask;

uniform float strength;

layout(location = 0) out vec4 radiance;

void main() {
    vec4 scene = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
    vec3 glow = texture(mask, 0.5 * gl_FragCoord.xy / vec2(textureSize(mask, 0))).rgb;
    radiance = vec4(storable(scene.rgb + strength * glow), scene.a);
}
