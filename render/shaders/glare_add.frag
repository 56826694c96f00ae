// Adds a half-resolution star to the image, with the colors of diffraction: longer wavelengths spread farther.
#version 450
#include "lib/radiance.glsl"
#include "fullscreen_gpu.h"
#include "glare_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(binding = kGlareSumUnit) uniform sampler2D star;

uniform float strength;

const vec3 kWavelengths = vec3(1.11, 1.0, 0.85);  // 610, 550 and 465 nm, relative to green

layout(location = 0) out vec4 radiance;

void main() {
    vec4 scene = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
    vec3 glare = texture(star, 0.5 * gl_FragCoord.xy / vec2(textureSize(star, 0))).rgb;
    radiance = vec4(storable(scene.rgb + strength * kWavelengths * glare), scene.a);
}
