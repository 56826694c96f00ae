// Tile max: reduces the result of depth_of_field_blocks.frag to tiles. Includes small near circles that overlap the
// tile and, as a small value, far circles next to it: they may be visible past the edge of a surface in it.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusBlocksUnit) uniform sampler2D blocks;
layout(binding = kFocusSmallBlocksUnit) uniform sampler2D small_of_blocks;

layout(location = 0) out vec4 tile;
layout(location = 1) out vec2 small;

const int kSide = kFocusTile / kFocusBlock;

void main() {
    ivec2 first = kSide * ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(blocks, 0) - 1;
    tile = vec4(0.0);
    small = vec2(0.0);
    for (int i = 0; i < (kSide + 2) * (kSide + 2); ++i) {
        ivec2 offset = ivec2(i % (kSide + 2), i / (kSide + 2)) - 1;
        ivec2 block_at = clamp(first + offset, ivec2(0), last);
        bool inside = all(greaterThanEqual(offset, ivec2(0))) && all(lessThan(offset, ivec2(kSide)));
        vec2 radii = texelFetch(small_of_blocks, block_at, 0).xy;
        small = max(small, inside ? radii : vec2(radii.x, 0.0));
        vec4 block = texelFetch(blocks, block_at, 0);
        tile = max(tile, inside ? block : vec4(0.0, 0.0, min(block.z, 0.25), 0.0));
    }
}
