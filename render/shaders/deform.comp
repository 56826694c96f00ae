// Morphing and skinning of all instances in one dispatch, one invocation per vertex: adds morph targets and applies
// joints (lib/skinning.glsl), for the current and the previous frame. Definition:
//   DEFORM_FLAGS  kDeform*
// Techniques: char.skin-gpu, char.skin-vertex-offset, face.bids-rebuild, wrinkle.compression.face-model
#version 450
#include "deform_gpu.h"
#include "lib/skinning.glsl"

layout(binding = kDeformControlsUnit) uniform samplerBuffer controls;  // packed deformers
#include "lib/deformers.glsl"
#include "lib/surface_patches.glsl"

layout(local_size_x = 64) in;                                              // kDeformGroup
layout(binding = kDeformJobsUnit) uniform usamplerBuffer jobs;             // DeformJob
layout(binding = kDeformGroupJobsUnit) uniform usamplerBuffer group_jobs;  // job of each work group
layout(binding = kDeformRestUnit) uniform usamplerBuffer rest;             // see deform_gpu.h
layout(binding = kDeformPalettesUnit) uniform samplerBuffer palettes;
layout(binding = kDeformWeightsUnit) uniform samplerBuffer weights;
layout(std430, binding = kDeformPositionsBinding) buffer Positions {
    float positions[];
};
layout(std430, binding = kDeformPreviousBinding) writeonly buffer Previous {
    float previous[];
};
layout(std430, binding = kDeformFramesBinding) writeonly buffer Frames {
    uvec4 frames[];  // PackedFrame
};

uniform uint first_group;
uniform uint group_count;
uniform uint first_vertex;  // in the bound range of the three buffers

const uint kFlags = uint(DEFORM_FLAGS);

struct Vertex {
    vec3 position;
    vec3 normal;
    vec3 tangent;
};

// Texel ranges of a vertex's data.
struct Lists {
    int texel;  // of the mesh
    int influence;
    int influence_end;
    int offset;
    int offset_end;
    int anchors;  // on the patches of a surface
    int anchor;   // the first of the vertex
};

vec3 unpack_turn(uint a, uint b, bool second) {
    vec2 u = unpackSnorm2x16(a);
    vec2 v = unpackSnorm2x16(b);
    return kMaxUnitDifference * (second ? vec3(u.y, v) : vec3(u, v.x));
}

Vertex add_morphs(Vertex v, Lists lists, int first_weight) {
    for (int i = lists.offset; i < lists.offset_end; i += int(kOffsetTexels)) {
        uvec4 move = texelFetch(rest, lists.texel + i);
        float w = texelFetch(weights, first_weight + int(move.w)).x;
        if (w != 0.0) {
            uvec4 turn = texelFetch(rest, lists.texel + i + 1);
            v.position += w * uintBitsToFloat(move.xyz);
            v.normal += w * unpack_turn(turn.x, turn.y, false);
            v.tangent += w * unpack_turn(turn.y, turn.z, true);
        }
    }
    return v;
}

Rows fetch_rows(int palette, uint joint) {
    int texel = palette + 3 * int(joint);
    return Rows(texelFetch(palettes, texel), texelFetch(palettes, texel + 1), texelFetch(palettes, texel + 2));
}

Vertex move_by_rows(Vertex v, Lists lists, int palette) {
    Rows sum = Rows(vec4(0.0), vec4(0.0), vec4(0.0));
    Rows strongest = sum;
    float max_weight = 0.0;
    for (int i = lists.influence; i < lists.influence_end; ++i) {
        uvec4 two = texelFetch(rest, lists.texel + i);
        vec2 w = uintBitsToFloat(two.yw);
        Rows first = fetch_rows(palette, two.x);
        Rows second = fetch_rows(palette, two.z);
        sum = add_rows(add_rows(sum, w.x, first), w.y, second);
        strongest = choose_rows(w.x > max_weight, first, strongest);
        max_weight = max(max_weight, w.x);
        strongest = choose_rows(w.y > max_weight, second, strongest);
        max_weight = max(max_weight, w.y);
    }
    vec3 normal = rows_normal(sum, strongest, v.normal);
    return Vertex(rows_point(sum, v.position), normal, rows_vector(sum, v.tangent));
}

// v' = sum w M o, n' = sum w M N, t' = sum w M T, normalized by main().
Vertex move_by_offsets(Lists lists, int palette) {
    Vertex sum = Vertex(vec3(0.0), vec3(0.0), vec3(0.0));
    for (int i = lists.influence; i < lists.influence_end; i += int(kJointOffsetTexels)) {
        uvec4 a = texelFetch(rest, lists.texel + i);
        uvec4 b = texelFetch(rest, lists.texel + i + 1);
        uvec4 c = texelFetch(rest, lists.texel + i + 2);
        Rows joint = fetch_rows(palette, b.w);
        float w = uintBitsToFloat(a.w);
        sum.position += w * rows_point(joint, uintBitsToFloat(a.xyz));
        sum.normal += w * rows_vector(joint, uintBitsToFloat(b.xyz));
        sum.tangent += w * rows_vector(joint, uintBitsToFloat(c.xyz));
    }
    return sum;
}

Dual fetch_dual(int palette, uint joint) {
    int texel = palette + 2 * int(joint);
    return Dual(texelFetch(palettes, texel), texelFetch(palettes, texel + 1));
}

Vertex move_by_duals(Vertex v, Lists lists, int palette) {
    Dual first = fetch_dual(palette, texelFetch(rest, lists.texel + lists.influence).x);
    Dual sum = Dual(vec4(0.0), vec4(0.0));
    for (int i = lists.influence; i < lists.influence_end; ++i) {
        uvec4 two = texelFetch(rest, lists.texel + i);
        vec2 w = uintBitsToFloat(two.yw);
        sum = add_dual(sum, w.x, fetch_dual(palette, two.x), first.real);
        sum = add_dual(sum, w.y, fetch_dual(palette, two.z), first.real);
    }
    Dual d = unit_dual(sum, first);
    return Vertex(dual_point(d, v.position), dual_vector(d, v.normal), dual_vector(d, v.tangent));
}

Vertex apply_controls(Vertex v, int first) {
    vec3 normal = unit_or(v.normal, vec3(0.0, 0.0, 1.0));
    vec3 across = unit_or(cross(abs(normal.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0), normal), normal);
    vec3 along = cross(normal, across);
    vec3 turned = cross(deform_vector(first, v.position, across), deform_vector(first, v.position, along));
    vec3 tangent = deform_vector(first, v.position, unit_or(v.tangent, across));
    return Vertex(deform_point(first, v.position), unit_or(turned, normal), tangent);
}

// `texel`: of the vertex's first anchor; those of the mesh begin at `anchors`.
Vertex follow_surface(Vertex v, int anchors, int texel, int patches) {
    Vertex moved = Vertex(vec3(0.0), vec3(0.0), vec3(0.0));
    float stays = 1.0;
    bool ends = texelFetch(rest, texel).x == kNoPatch;
    while (!ends) {
        uvec4 a = texelFetch(rest, texel);
        vec4 b = uintBitsToFloat(texelFetch(rest, texel + 1));
        vec4 c = uintBitsToFloat(texelFetch(rest, texel + 2));
        uvec4 d = texelFetch(rest, texel + 3);
        vec3 offset = vec3(uintBitsToFloat(a.w), b.xy);
        PatchPoint at = evaluate_patch(patches + kPatchTexels * int(a.x), uintBitsToFloat(a.y), uintBitsToFloat(a.z));
        mat3 axes = patch_axes(at, offset.z);
        float share = uintBitsToFloat(d.x);
        stays -= share;
        moved.position += share * point_on_patch(at, offset);
        moved.normal += share * unit_or(patch_normal(axes, vec3(b.zw, c.x)), v.normal);
        moved.tangent += share * unit_or(axes * c.yzw, v.tangent);
        ends = d.y == 0u;
        texel = anchors + int(kOnPatchTexels * d.y);
    }
    return Vertex(
        stays * v.position + moved.position,
        unit_or(stays * v.normal + moved.normal, v.normal),
        unit_or(stays * v.tangent + moved.tangent, v.tangent));
}

Vertex deformed(Vertex v, Lists lists, uint palette, uint first_weight, uint first_control, uint patches) {
    if ((kFlags & kDeformPatches) != 0u) {
        v = follow_surface(v, lists.anchors, lists.anchor, int(patches));
    }
    if ((kFlags & kDeformMorphs) != 0u) {
        v = add_morphs(v, lists, int(first_weight));
    }
    if ((kFlags & kDeformControls) != 0u) {
        v = apply_controls(v, int(first_control));
    }
    if ((kFlags & kDeformJoints) == 0u || lists.influence == lists.influence_end) {
        return v;
    }
    if ((kFlags & kDeformOffsets) != 0u) {
        return move_by_offsets(lists, int(palette));
    }
    return (kFlags & kDeformDual) != 0u ? move_by_duals(v, lists, int(palette))
                                        : move_by_rows(v, lists, int(palette));
}

void main() {
    uint group = gl_WorkGroupID.y * kDeformGroupsWide + gl_WorkGroupID.x;
    if (group >= group_count) {
        return;
    }
    group += first_group;
    int job = int(kDeformJobTexels * texelFetch(group_jobs, int(group)).x);
    uvec4 job0 = texelFetch(jobs, job);      // rest, vertex_count, slot, first_group
    uvec4 job1 = texelFetch(jobs, job + 1);  // palette, previous_palette, weights, previous_weights
    uvec4 job2 = texelFetch(jobs, job + 2);  // controls, previous_controls, patches, previous_patches
    uint number = (group - job0.w) * kDeformGroup + gl_LocalInvocationID.x;
    if (number >= job0.y) {
        return;
    }
    uint vertex = job0.z + number - first_vertex;

    if ((kFlags & kDeformCopyPrevious) != 0u) {
        for (uint i = 0u; i < 3u; ++i) {
            previous[3u * vertex + i] = positions[3u * vertex + i];
        }
    }
    int texel = int(job0.x + kRestTexels * number);
    uvec4 a = texelFetch(rest, texel);
    uvec4 b = texelFetch(rest, texel + 1);
    uvec4 c = texelFetch(rest, texel + 2);
    Vertex v = Vertex(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz));
    int anchors = int(job0.x + kRestTexels * (job0.y + 1u));
    Lists lists = Lists(
        int(job0.x),
        int(a.w),
        int(texelFetch(rest, texel + int(kRestTexels)).w),
        int(b.w),
        int(texelFetch(rest, texel + int(kRestTexels) + 1).w),
        anchors,
        anchors + int(kOnPatchTexels * number));
    if ((kFlags & kDeformPrevious) != 0u) {
        vec3 p = deformed(v, lists, job1.y, job1.w, job2.y, job2.w).position;
        previous[3u * vertex] = p.x;
        previous[3u * vertex + 1u] = p.y;
        previous[3u * vertex + 2u] = p.z;
    }
    if ((kFlags & kDeformCurrent) != 0u) {
        Vertex now = deformed(v, lists, job1.x, job1.z, job2.x, job2.z);
        positions[3u * vertex] = now.position.x;
        positions[3u * vertex + 1u] = now.position.y;
        positions[3u * vertex + 2u] = now.position.z;
        vec3 normal = unit_or(now.normal, uintBitsToFloat(b.xyz));
        vec3 tangent = unit_or(now.tangent, uintBitsToFloat(c.xyz));
        frames[vertex] = uvec4(
            packSnorm2x16(normal.xy),
            packSnorm2x16(vec2(normal.z, 0.0)),
            packSnorm2x16(tangent.xy),
            packSnorm2x16(vec2(tangent.z, uintBitsToFloat(c.w))));
    }
}
