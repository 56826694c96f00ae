// Marks pixels that show water by the depth at which water.frag is drawn.
#version 450
#include "generated/model_numbers.glsl"
#include "water_gpu.h"

layout(binding = kVisibleWaterUnit) uniform usampler2DArray visible_water;  // water_surface.frag

void main() {
    bool is_water = texelFetch(visible_water, ivec3(gl_FragCoord.xy, 0), 0).w != 0u;
    gl_FragDepth = is_water ? float(kModelPbr) / 16.0 : 0.0;
}
