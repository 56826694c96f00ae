// One material, read from a texture buffer as kMaterialTexels RGBA32F texels, by its index. Parts that only some
// materials have follow after all records, as blocks (material_blocks_gpu.h).

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
#include "render/shaders/material_maps_gpu.h"
namespace limn::layout {
#endif

struct MaterialRecord {
    vec4 base_color;  // linear, opacity
    vec4 emission;    // w: strength of the normal map
    vec4 factors;     // metalness, roughness, strength of the occlusion map, alpha cutoff
    vec4 blocks;      // x: first texel of its blocks; yzw: offset of each kind from there
    vec4 maps[2];     // layers of its maps (material_maps_gpu.h)
};

const uint kMaterialTexels = 6u;

// Bindings.
const uint kMaterialsUnit = 12u;

#ifdef __cplusplus
static_assert(sizeof(MaterialRecord) == 16 * kMaterialTexels && kMapTexels == 2);
}  // namespace limn::layout
#endif
