// Strength of wrinkles at each vertex of deformed skin: measures the shortening of its triangles across them, in the
// buffers written by deform.comp, and the displacement by folds. One invocation per vertex gathers its triangles in a fixed order.
// Techniques: face.strain, face.wrinkle-options, wrinkle.comparison, wrinkle.compression.factor,
//     wrinkle.compression.fallback, wrinkle.compression.overlap, wrinkle.compression.skin-model,
//     wrinkle.compression.square-length, wrinkle.displacement, wrinkle.natural-width,
//     wrinkle.resting, wrinkle.smoothing
#version 450
#include "lib/wrinkle.glsl"
#include "wrinkle_gpu.h"

layout(local_size_x = 64) in;                                            // kWrinkleGroup
layout(binding = kWrinkleJobsUnit) uniform usamplerBuffer jobs;          // WrinkleJob
layout(binding = kWrinkleGroupsUnit) uniform usamplerBuffer group_jobs;  // job of each work group
layout(binding = kWrinkleRestUnit) uniform usamplerBuffer rest;          // see wrinkle_gpu.h
layout(std430, binding = kWrinklePositionsBinding) readonly buffer Positions {
    float positions[];
};
layout(std430, binding = kWrinklesBinding) writeonly buffer Wrinkles {
    uvec2 wrinkles[];  // four half floats, in the layout of mesh.vert
};
layout(std430, binding = kFoldHeightsBinding) writeonly buffer FoldHeights {
    float fold_heights[];  // along the normal, in mesh space [m]; written for displaced skin only
};

uniform uint group_count;
uniform uint first_vertex;  // in the bound range of the buffers

vec3 position_of(uint vertex) {
    return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// Squared length ratio to rest across wrinkles; 1 without a triangle, or where it is NaN or infinite.
float compression(int triangle, int end, uint vertex, uint first, bool mean_length) {
    vec3 at = position_of(vertex);
    float ratio = triangle == end ? 1.0 : 0.0;
    while (triangle < end) {
        uvec2 corners = texelFetch(rest, triangle).xy;
        bool by_stretch = (corners.x & kWrinkleStretch) != 0u;
        bool away = (corners.x & kWrinkleAway) != 0u;
        corners.x &= ~(kWrinkleStretch | kWrinkleAway);
        vec2 across = uintBitsToFloat(texelFetch(rest, triangle + 1).xy);
        uvec2 more = by_stretch || away ? texelFetch(rest, triangle + 2).xy : uvec2(0u);
        vec3 from = away ? position_of(first + more.y) : at;
        vec3 chord = across.x * (position_of(first + corners.x) - from) + across.y * (position_of(first + corners.y) - from);
        float along = dot(chord, chord);
        if (by_stretch) {
            along = max(along - uintBitsToFloat(more.x), 0.0);
        }
        ratio += mean_length ? sqrt(along) : along;
        triangle += by_stretch || away ? 3 : 2;
    }
    ratio = mean_length ? ratio * ratio : ratio;
    return ratio >= 0.0 && ratio < 1e30 ? ratio : 1.0;
}

// The compression of a vertex by a block of the mesh at `rest_first`.
float block_compression(uint rest_first, uint block, uint number, uint first, bool mean_length) {
    int at = int(rest_first + block + number);
    int begin = int(rest_first + texelFetch(rest, at).x);
    int end = int(rest_first + texelFetch(rest, at + 1).x);
    return compression(begin, end, first + number, first, mean_length);
}

// FoldTable of a job, linearly interpolated.
float fold_strength(int job, float e) {
    float entry = clamp(e, 0.0, 1.0) * float(kFoldSteps - 1u);
    int i = min(int(entry), int(kFoldSteps) - 2);
    float low = uintBitsToFloat(texelFetch(jobs, job + 4 + i / 4)[i % 4]);
    float high = uintBitsToFloat(texelFetch(jobs, job + 4 + (i + 1) / 4)[(i + 1) % 4]);
    return mix(low, high, entry - float(i)) * sqrt(clamp(e, 0.0, 1.0));
}

// Strength of the wrinkles at this compression, without the mask: for isometric folds, and for all other methods.
float folded_strength(int job, uvec4 job1, float folding, float ratio) {
    return fold_strength(job, fold_excess(ratio, uintBitsToFloat(job1.w), folding));
}
float raised_strength(uvec4 job1, float ratio) {
    return max(wrinkle_intensity(ratio, uintBitsToFloat(job1.y), uintBitsToFloat(job1.z)), 0.0);
}
float strength_of(int job, uvec4 job1, float folding, float ratio) {
    return job1.x == kWrinkleIsometric ? folded_strength(job, job1, folding, ratio) : raised_strength(job1, ratio);
}

void main() {
    uint group = gl_WorkGroupID.y * kWrinkleGroupsWide + gl_WorkGroupID.x;
    if (group >= group_count) {
        return;
    }
    int job = int(kWrinkleJobTexels * texelFetch(group_jobs, int(group)).x);
    uvec4 job0 = texelFetch(jobs, job);      // rest, vertex_count, slot, first_group
    uvec4 job1 = texelFetch(jobs, job + 1);  // method, lambda, beta, slack
    uint number = (group - job0.w) * kWrinkleGroup + gl_LocalInvocationID.x;
    if (number >= job0.y) {
        return;
    }
    uvec4 job2 = texelFetch(jobs, job + 2);  // fold_fraction, driver, mean_length, activation
    uvec4 job3 = texelFetch(jobs, job + 3);  // second, third, own_weight, shade_weight
    uint first = job0.z - first_vertex;
    uvec4 job8 = texelFetch(jobs, job + 8);  // heights, displacement, resting
    float resting = uintBitsToFloat(job8.z);
    vec2 mask_and_rest = unpackUnorm2x16(texelFetch(rest, int(job0.x + number)).y);
    float mask = mask_and_rest.x;
    bool mean_length = job2.z != 0u;
    float ratio = block_compression(job0.x, 0u, number, first, mean_length);
    if (job2.y == kWrinkleByStrain) {
        float along_v = block_compression(job0.x, job3.x, number, first, mean_length);
        float between = block_compression(job0.x, job3.y, number, first, mean_length);
        if (job1.x == kWrinkleStrainView || job1.x == kWrinkleModel) {
            float angle = uintBitsToFloat(texelFetch(rest, int(job0.x + job3.x + number)).y);
            float side = uintBitsToFloat(texelFetch(rest, int(job0.x + job3.y + number)).y);
            vec3 strain = strain_of_tensor(ratio, along_v, between, angle, side);
            float known = abs(side) * (job1.x == kWrinkleModel ? mask * uintBitsToFloat(job3.z) : 1.0);
            wrinkles[first + number] = uvec2(packHalf2x16(strain.xy), packHalf2x16(vec2(strain.z, known)));
            return;
        }
        ratio = shortest_ratio(ratio, along_v, between);
    }

    float measured = ratio;
    ratio = rested_ratio(ratio, resting * mask_and_rest.y);

    uint method = job1.x;
    float activation = uintBitsToFloat(job2.w);
    float folding = uintBitsToFloat(job2.x);
    if (method == kWrinkleColumns) {
        vec2 both = vec2(folded_strength(job, job1, folding, ratio), raised_strength(job1, ratio));
        both = mask * activation * (job2.y == kWrinkleByRadius ? vec2(1.0) : both);
        wrinkles[first + number] = uvec2(packHalf2x16(both), 0u);
        return;
    }
    float strength = mask * activation * (job2.y == kWrinkleByRadius ? 1.0 : strength_of(job, job1, folding, ratio));
    bool steep = method == kWrinkleBump || method == kWrinkleIsometric || method == kWrinkleBlend;
    float own = strength * uintBitsToFloat(job3.z);
    float shade = min(strength, 1.0) * uintBitsToFloat(job3.w);
    vec4 by_method = own * vec4(
        steep ? 1.0 : 0.0,
        method == kWrinkleSphere ? 1.0 : 0.0,
        method == kWrinkleAlpha || method == kWrinklePhoto ? 1.0 : 0.0,
        method == kWrinkleDirectional ? 1.0 : 0.0);
    by_method.z += shade;
    vec2 own_ratio = vec2(measured, 1.0);
    if (job3.x != 0u && job2.y != kWrinkleByStrain) {  // a second layer: its strengths are y and w
        vec2 second_mask = unpackUnorm2x16(texelFetch(rest, int(job0.x + job3.x + number)).y);
        own_ratio.y = block_compression(job0.x, job3.x, number, first, mean_length);
        float second_ratio = rested_ratio(own_ratio.y, resting * second_mask.y);
        float second = second_mask.x * activation * strength_of(job, job1, folding, second_ratio);
        float second_own = second * uintBitsToFloat(job3.z);
        by_method.y = steep ? second_own : 0.0;
        by_method.w = (steep ? 0.0 : second_own) + min(second, 1.0) * uintBitsToFloat(job3.w);
    }
    wrinkles[first + number] = uvec2(packHalf2x16(by_method.xy), packHalf2x16(by_method.zw));

    if (job8.x != 0u) {
        // Slopes refer to the deformed skin, heights to skin at rest, where folds are longer.
        vec2 heights = uintBitsToFloat(texelFetch(rest, int(job0.x + job8.x + number)).xy) * sqrt(own_ratio);
        fold_heights[first + number] = uintBitsToFloat(job8.y) * dot(heights, by_method.xy);
    }
}
