// The weighted mean of all layers of particles, over what is behind them (render/particles/particle_weighted.h).
// Techniques: particle.weighted-blended
#version 450
#include "lib/radiance.glsl"
#include "particle_gpu.h"

layout(binding = kWeightedSumUnit) uniform sampler2D sum;
layout(binding = kWeightedKeptUnit) uniform sampler2D kept;

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 layers = texelFetch(sum, at, 0);
    float covered = 1.0 - texelFetch(kept, at, 0).r;
    radiance = vec4(storable(layers.rgb * (covered / max(layers.a, 1e-20))), covered);
}
