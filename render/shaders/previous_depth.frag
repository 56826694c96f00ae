// A copy of the depth, for the next frame (render/particles/previous_depth.h).
#version 450
#include "particle_gpu.h"

layout(binding = kParticleDepthUnit) uniform sampler2D scene_depth;

layout(location = 0) out float depth;

void main() {
    depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
}
