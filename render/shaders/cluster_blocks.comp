// Coarse light culling: a bit mask of the lights that may touch each block of cells; word w of a block has the bits of
// lights 32 w .. 32 w + 31. Compares only boxes of cells; one invocation per word.
#version 450
#include "cluster_gpu.h"
#include "lib/cluster.glsl"

layout(local_size_x = 32) in;  // blocks
layout(binding = kClusterLightsUnit) uniform samplerBuffer cluster_lights;  // ClusterLight
layout(binding = kClusterBoxesUnit) uniform usamplerBuffer boxes;  // ClusterLights::boxes
layout(std430, binding = kClusterMasksBinding) writeonly buffer Masks {
    uint masks[];  // words of block 0, of block 1 ...
};

void main() {
    uvec3 blocks = block_counts();
    uint block = gl_GlobalInvocationID.x;
    if (block >= blocks.x * blocks.y * blocks.z) {
        return;
    }
    uvec3 first = block_position(block) * kBlockSize;
    uvec3 last = first + kBlockSize - 1u;
    uint light_count = light_count_of(cluster_lights);
    uint word = gl_WorkGroupID.y;
    uint begin = word * 32u;
    uint count = min(32u, light_count - min(begin, light_count));
    uint bits = 0u;
    for (uint i = 0u; i < count; ++i) {
        bits |= boxes_intersect(texelFetch(boxes, int(begin + i)).xy, first, last) ? 1u << i : 0u;
    }
    masks[block * word_count(light_count) + word] = bits;
}
