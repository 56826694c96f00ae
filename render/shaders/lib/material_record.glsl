// The records of materials, by index.

#include "material_gpu.h"

layout(binding = 12) uniform samplerBuffer materials;  // MaterialRecord

// Texel `i` of a MaterialRecord.
vec4 material_texel(uint material, int i) {
    return texelFetch(materials, int(material * kMaterialTexels) + i);
}
