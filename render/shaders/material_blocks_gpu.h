// Blocks: parts of a material's record that only some materials have. A kind of block is a struct in a header of its
// own, a number here and a row in render/material/material_blocks.cpp; shaders read it with block_texel()
// (lib/material_record.glsl). The record holds the first texel of each kind, counted from the material's first block:
// four to a float, as an integer that a float stores exactly. Texel indices are exact, too, up to 2^24 (a million
// materials).

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kUvBlock = 0u;          // material_maps_gpu.h
const uint kClassicBlock = 1u;     // material_classic_gpu.h
const uint kSkinBlock = 2u;        // material_skin_gpu.h
const uint kLafortuneBlock = 3u;   // material_lafortune_gpu.h
const uint kClearBlock = 4u;       // material_clear_gpu.h
const uint kHairBlock = 5u;        // material_hair_gpu.h
const uint kSubsurfaceBlock = 6u;  // material_subsurface_gpu.h
const uint kLayersBlock = 7u;      // material_layers_gpu.h
const uint kReliefBlock = 8u;      // relief_gpu.h
const uint kToonBlock = 9u;        // material_toon_gpu.h
const uint kStrandBlock = 10u;     // material_strand_gpu.h
const uint kDressBlock = 11u;      // material_dress_gpu.h

const uint kBlockOffsetBits = 6u;
const uint kBlocksPerFloat = 4u;
const uint kMaxBlockKinds = 3u * kBlocksPerFloat;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
