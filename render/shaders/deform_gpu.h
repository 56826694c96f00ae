// What deform.comp reads, as texels of four 32-bit numbers. C++ and GLSL read the same text.
//
// A mesh at rest is a block of texels: three a vertex - position and its first influence, normal and its first
// offset, tangent - and one vertex more, which ends the lists of the last; then influences, two a texel - joint,
// weight, joint, weight - and offsets, two texels each - position and target, normal and tangent as six 16-bit
// shares of kLargestTurn. Places in these lists count texels from the beginning of the block.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kRestTexels = 3u;    // a vertex
const uint kOffsetTexels = 2u;  // an offset of a morph target
const float kLargestTurn = 2.0; // no two unit vectors differ by more

// One instance to be deformed: two texels.
struct DeformJob {
    uint rest;            // first texel of the mesh
    uint vertex_count;
    uint slot;            // first of its vertices among the deformed ones
    uint first_group;     // work group of its first vertex
    uint palette;         // first texel of its joints: three rows each, or the two parts of a dual quaternion
    uint palette_before;
    uint weights;         // first of its morph weights
    uint weights_before;
};

const uint kDeformJobTexels = 2u;
const uint kDeformGroup = 64u;        // vertices
const uint kDeformGroupsWide = 1024u; // groups of a dispatch along x

// What a dispatch does, and all its jobs alike: a program each, as llvmpipe walks through every branch.
const uint kDeformNow = 1u;         // writes what is drawn
const uint kDeformBefore = 2u;      // reckons the positions before
const uint kDeformCopyBefore = 4u;  // what was drawn last are the positions before
const uint kDeformJoints = 8u;      // has a palette
const uint kDeformDual = 16u;       // of dual quaternions
const uint kDeformMorphs = 32u;     // has morph weights, one a target

#ifdef __cplusplus
static_assert(sizeof(DeformJob) == 16 * kDeformJobTexels);
}  // namespace limn::layout
#endif
