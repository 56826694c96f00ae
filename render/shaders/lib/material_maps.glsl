// The textures of the maps of a material.

#include "lib/material_record.glsl"
#include "material_maps_gpu.h"

layout(binding = kFirstMapUnit) uniform sampler2DArray material_maps[kMapUnits];
