// A point or spot light for clustered culling, in view space: x right, y up, z along the view axis.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ClusterLight {
    vec4 sphere;  // bounds the lit volume [m]; w: radius squared [m^2], negative: unbounded
    vec4 apex;    // position [m]; w: cosine of the cone's half angle, -1 or less: no cone
    vec4 axis;    // direction of a spot, unit; w: index in the list of all lights
};

const uint kClusterLightTexels = 3u;

// Cells are culled in blocks of this many columns, rows and slices; a block's lights are a bit mask.
const uint kBlockColumns = 4u;
const uint kBlockRows = 4u;
const uint kBlockSlices = 2u;
const uint kBlockCells = 32u;

// Bindings.
const uint kClusterLightsUnit = 0u;
const uint kClusterBoxesUnit = 1u;
const uint kClusterMasksBinding = 0u;
const uint kClusterCellsBinding = 1u;
const uint kClusterIndicesBinding = 2u;

#ifdef __cplusplus
static_assert(sizeof(ClusterLight) == 16 * kClusterLightTexels);
static_assert(kBlockColumns * kBlockRows * kBlockSlices == kBlockCells);
}  // namespace limn::layout
#endif
