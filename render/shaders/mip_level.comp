// A mip level from the next finer one, filtered linearly at the center of each texel.
#version 450
#include "fullscreen_gpu.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kSourceUnit) uniform sampler2D source;  // all levels
layout(binding = kTargetImage) writeonly uniform image2D level;  // of any format

uniform int source_level;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(level);
    if (all(lessThan(texel, size))) {
        vec2 uv = (vec2(texel) + 0.5) / vec2(size);
        imageStore(level, texel, textureLod(source, uv, float(source_level)));
    }
}
