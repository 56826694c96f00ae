// The textures of the maps of a material, and their texture coordinates. Definitions:
//   UV_MAP   all maps share a uv set and transform; otherwise they use the first set untransformed
//   UV_MAPS  each has its own

#include "lib/material_record.glsl"
#include "material_maps_gpu.h"

layout(binding = kFirstMapUnit) uniform sampler2DArray material_maps[kMapUnits];

// Maps the texture coordinates `sets`, with offset 0 a difference of them, to those of a map.
vec2 map_coordinates(uint material, uint slot, vec4 sets, float offset_factor) {
#if defined(UV_MAPS) || defined(UV_MAP)
#ifdef UV_MAP
    slot = 0u;  // all are the same
#endif
    vec4 rows = block_texel(material, kUvBlock, 2 * int(slot));
    vec4 offset = block_texel(material, kUvBlock, 2 * int(slot) + 1);
    vec2 set = offset.z > 0.5 ? sets.zw : sets.xy;
    return vec2(dot(rows.xy, set), dot(rows.zw, set)) + offset_factor * offset.xy;
#else
    return sets.xy;
#endif
}
