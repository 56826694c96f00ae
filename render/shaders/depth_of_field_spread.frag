// Dilates blocks: widest radius [px] of the small near circles that overlap a block.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusSmallBlocksUnit) uniform sampler2D small_of_blocks;

layout(location = 0) out float widest;

void main() {
    ivec2 last = textureSize(small_of_blocks, 0) - 1;
    widest = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 neighbor = ivec2(gl_FragCoord.xy) + ivec2(i % 3, i / 3) - 1;
        widest = max(widest, texelFetch(small_of_blocks, clamp(neighbor, ivec2(0), last), 0).x);
    }
}
