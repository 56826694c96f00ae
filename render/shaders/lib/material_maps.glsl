// The textures of the maps of a material.

#include "lib/material_record.glsl"

layout(binding = 0) uniform sampler2DArray material_maps[kMapUnits];
