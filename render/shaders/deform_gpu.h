// Input of deform.comp, as texels of four 32-bit numbers. Shared by C++ and GLSL.
//
// A mesh in bind pose is a block of texels: three per vertex - position and its first influence, normal and its first
// offset, tangent - and a sentinel vertex, which ends the lists of the last; for a mesh on the patches of a surface
// four more per anchor - patch, u, v, offset, normal, tangent, share, next (surface_anchors.h); then influences, two per
// texel - joint, weight, joint, weight - and morph offsets, two texels each - position and target, normal and tangent as six
// 16-bit fractions of kMaxUnitDifference. Indices into these lists count texels from the beginning of the block.
// With kDeformOffsets influences are three texels each, in the space of the joint: position and weight, normal and
// joint, tangent.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kRestTexels = 3u;    // per vertex
const uint kOnPatchTexels = 4u;  // per anchor on patches
const uint kOffsetTexels = 2u;  // per offset of a morph target
const uint kJointOffsetTexels = 3u;  // per influence, with kDeformOffsets
const float kMaxUnitDifference = 2.0; // largest difference of two unit vectors, by component

// One instance to deform: three texels.
struct DeformJob {
    uint rest;            // first texel of the mesh
    uint vertex_count;
    uint slot;            // its first vertex in the buffers of deformed vertices
    uint first_group;     // work group of its first vertex
    uint palette;         // first texel of its joints: three rows each, or the two parts of a dual quaternion
    uint previous_palette;  // the same in the previous frame
    uint weights;         // first of its morph weights
    uint previous_weights;
    uint controls;        // first texel of its packed deformers (lib/deformers.glsl)
    uint previous_controls;
    uint patches;         // first texel of the patches of its surface (lib/surface_patches.glsl), among the controls
    uint previous_patches;
};

const uint kDeformJobTexels = 3u;
const uint kDeformGroup = 64u;        // vertices
const uint kDeformGroupsWide = 1024u; // groups of a dispatch along x

// What a dispatch does, the same for all its jobs. One program per combination, as llvmpipe executes every branch.
const uint kDeformCurrent = 1u;         // writes the current vertices
const uint kDeformPrevious = 2u;      // evaluates the previous positions
const uint kDeformCopyPrevious = 4u;  // copies the last drawn positions to the previous ones
const uint kDeformJoints = 8u;      // has a palette
const uint kDeformDual = 16u;       // of dual quaternions
const uint kDeformMorphs = 32u;     // has morph weights, one per target
const uint kDeformControls = 64u;   // has deformers
const uint kDeformPatches = 128u;   // is on the patches of a surface
const uint kDeformOffsets = 256u;   // has vertices in the spaces of their joints

// Bindings.
const uint kDeformJobsUnit = 0u;
const uint kDeformGroupJobsUnit = 1u;
const uint kDeformRestUnit = 2u;
const uint kDeformPalettesUnit = 3u;
const uint kDeformWeightsUnit = 4u;
const uint kDeformControlsUnit = 5u;
const uint kDeformPositionsBinding = 0u;
const uint kDeformPreviousBinding = 1u;
const uint kDeformFramesBinding = 2u;

#ifdef __cplusplus
static_assert(sizeof(DeformJob) == 16 * kDeformJobTexels);
}  // namespace limn::layout
#endif
