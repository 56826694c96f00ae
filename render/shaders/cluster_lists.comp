// The lights of each cell: those in its block's mask whose box of cells contains it and whose sphere and cone touch
// it, in the order of the lights. Run twice: without definitions it counts, and after cluster_scan.comp with
//   FILL  it writes the lists
// Techniques: light.clustered
#version 450
#include "cluster_gpu.h"
#include "lib/cluster.glsl"

layout(local_size_x = 32) in;  // the cells of a block
layout(binding = kClusterLightsUnit) uniform samplerBuffer cluster_lights;  // ClusterLight
layout(binding = kClusterBoxesUnit) uniform usamplerBuffer boxes;
layout(std430, binding = kClusterMasksBinding) readonly buffer Masks {
    uint masks[];
};
layout(std430, binding = kClusterCellsBinding) buffer Cells {
    uvec2 cells[];  // begin and length of each list
};
#ifdef FILL
layout(std430, binding = kClusterIndicesBinding) writeonly buffer Indices {
    uint indices[];
};
#endif

bool touches(int light, uvec3 cell, CellBox box, vec3 center, float half_diagonal) {
    vec4 sphere = texelFetch(cluster_lights, light * int(kClusterLightTexels));
    vec4 apex = texelFetch(cluster_lights, light * int(kClusterLightTexels) + 1);
    vec3 axis = texelFetch(cluster_lights, light * int(kClusterLightTexels) + 2).xyz;
    return boxes_intersect(texelFetch(boxes, light).xy, cell, cell) && !sphere_outside(sphere.xyz, sphere.w, box)
           && !cone_outside(apex.xyz, axis, apex.w, center, half_diagonal);
}

void main() {
    uint i = gl_LocalInvocationID.x;
    uvec3 offset = uvec3(i % kBlockColumns, i / kBlockColumns % kBlockRows, i / (kBlockColumns * kBlockRows));
    uvec3 cell = block_position(gl_WorkGroupID.x) * kBlockSize + offset;
    uvec3 n = cell_counts();
    bool inside = all(lessThan(cell, n));
    uint number = inside ? (cell.z * n.y + cell.y) * n.x + cell.x : 0u;
    CellBox box = cell_box(min(cell, n - 1u));
    vec3 center = 0.5 * (box.low + box.high);
    float half_diagonal = 0.5 * length(box.high - box.low);

    uint words = word_count(light_count_of(cluster_lights));
    uint first = gl_WorkGroupID.x * words;
    uint found = 0u;
#ifdef FILL
    uint begin = cells[number].x;
#endif
    for (uint word = 0u; word < words; ++word) {
        uint bits = masks[first + word];
        while (bits != 0u) {  // uniform over the block
            int light = int(word * 32u) + findLSB(bits);
            bits &= bits - 1u;
            if (inside && touches(light, cell, box, center, half_diagonal)) {
#ifdef FILL
                indices[begin + found] = uint(texelFetch(cluster_lights, light * int(kClusterLightTexels) + 2).w);
#endif
                ++found;
            }
        }
    }
#ifndef FILL
    if (inside) {
        cells[number] = uvec2(0u, found);
    }
#endif
}
