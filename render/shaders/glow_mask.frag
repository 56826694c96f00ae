// Emission of surfaces at half resolution: the mean of four pixels, so that small lamps do not flicker.
#version 450
#include "lib/gbuffer.glsl"
#include "glow_gpu.h"

layout(binding = kGlowSurfaceUnit) uniform usampler2D gbuffer;
layout(binding = kGlowDepthUnit) uniform sampler2D scene_depth;

layout(location = 0) out vec4 mask;

vec3 emission_at(ivec2 at) {
    at = min(at, textureSize(scene_depth, 0) - 1);
    vec3 emission = unpack_rgb9e5(texelFetch(gbuffer, at, 0).w);
    return texelFetch(scene_depth, at, 0).r > 0.0 ? emission : vec3(0.0);
}

void main() {
    ivec2 at = 2 * ivec2(gl_FragCoord.xy);
    vec3 sum = emission_at(at) + emission_at(at + ivec2(1, 0)) + emission_at(at + ivec2(0, 1))
               + emission_at(at + ivec2(1, 1));
    mask = vec4(0.25 * sum, 1.0);
}
