// The records of materials, by index.
// Techniques: engine.multi-material

#include "material_blocks_gpu.h"
#include "material_gpu.h"
#include "material_maps_gpu.h"

layout(binding = kMaterialsUnit) uniform samplerBuffer materials;  // MaterialRecord, then blocks

// Texel `i` of a MaterialRecord.
vec4 material_texel(uint material, int i) {
    return texelFetch(materials, int(material * kMaterialTexels) + i);
}

// First texel of a block of the material; meaningless if the material lacks the block.
int block_begin(uint material, uint kind) {
    vec4 blocks = material_texel(material, 3);
    uint offsets = uint(blocks[1u + kind / kBlocksPerFloat]);
    uint offset = bitfieldExtract(offsets, int(kind % kBlocksPerFloat * kBlockOffsetBits), int(kBlockOffsetBits));
    return int(blocks.x) + int(offset);
}

// Texel `i` of a block.
vec4 block_texel(uint material, uint kind, int i) {
    return texelFetch(materials, block_begin(material, kind) + i);
}

// The layers of the first maps of a material.
vec4 map_layers_of(uint material) {
    return material_texel(material, 4);
}

// Layer of one of the first maps in its texture array.
float map_layer(vec4 layers, uint slot) {
    uint bits = uint(layers[slot / kLayersPerFloat]);
    return float(bitfieldExtract(bits, int(slot % kLayersPerFloat * kLayerBits), int(kLayerBits)));
}

// All stages of a program must declare the same varyings.
#if defined(BASE_COLOR_MAP) || defined(METAL_ROUGH_MAP) || defined(NORMAL_MAP) || defined(OCCLUSION_MAP) || defined(EMISSION_MAP) || defined(WRINKLE_MAP) || defined(DETAIL_MAP) || defined(THICKNESS_MAP) || defined(RELIEF_MAP) || defined(CLEARCOAT_MAP) || defined(CLEARCOAT_ROUGHNESS_MAP) || defined(CLEARCOAT_NORMAL_MAP) || defined(SHEEN_MAP) || defined(SHEEN_ROUGHNESS_MAP) || defined(SPECULAR_WEIGHT_MAP) || defined(SPECULAR_TINT_MAP) || defined(ANISOTROPY_MAP) || defined(IRIDESCENCE_MAP) || defined(IRIDESCENCE_THICKNESS_MAP) || defined(NORMAL_SPREAD_MAP) || defined(TRANSMISSION_MAP) || defined(LIGHT_MAP)
#define MAP_LAYERS
#endif
