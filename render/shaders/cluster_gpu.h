// A point or spot light as the clusters see it: view space with x right, y up and z along the view axis.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ClusterLight {
    vec4 sphere;  // around all that it lights [m]; w: radius squared [m^2], negative: everywhere
    vec4 apex;    // where it is [m]; w: cosine of the cone's half angle, -1 or less: no cone
    vec4 axis;    // where a spot shines, unit; w: index in the list of all lights
};

const uint kClusterLightTexels = 3u;

// Cells are tested in blocks of so many columns, rows and slices; a block's lights are bits of words.
const uint kBlockColumns = 4u;
const uint kBlockRows = 4u;
const uint kBlockSlices = 2u;
const uint kBlockCells = 32u;

#ifdef __cplusplus
static_assert(sizeof(ClusterLight) == 16 * kClusterLightTexels);
static_assert(kBlockColumns * kBlockRows * kBlockSlices == kBlockCells);
}  // namespace limn::layout
#endif
