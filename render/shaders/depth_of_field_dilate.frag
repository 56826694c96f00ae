// Dilates tiles: classifies a tile by its own circles and by those of its neighbors that overlap it.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusOwnTilesUnit) uniform sampler2D own_tiles;
layout(binding = kFocusOwnSmallUnit) uniform sampler2D own_small;

// Widest radius [px] of the near circles that overlap the tile, fine and coarse; if it has far pixels, of the fine far
// circles that overlap it, at least slightly above 0; of the wide far circles in it or next to it.
layout(location = 0) out vec4 tile;
// Of small circles: near ones that overlap the tile; far ones, if any pixel of the tile is behind the focus.
layout(location = 1) out vec2 slight;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(own_tiles, here, 0);
    slight = texelFetch(own_small, here, 0).xy;
    bool is_far = own.z > 0.0;
    bool is_behind = is_far || slight.y > 0.0;
    tile = vec4(own.xy, is_far ? 0.25 : 0.0, 0.0);
    int range = focus.tiles.z;
    for (int y = -range; y <= range; ++y) {
        for (int x = -range; x <= range; ++x) {
            ivec2 neighbor = clamp(here + ivec2(x, y), ivec2(0), focus.tiles.xy - 1);
            vec4 other = texelFetch(own_tiles, neighbor, 0);
            float gap = length(vec2(max(abs(ivec2(x, y)) - 1, ivec2(0)) * kFocusTile));
            tile.x = max(tile.x, other.x > gap ? other.x : 0.0);
            tile.y = max(tile.y, other.y > gap ? other.y : 0.0);
            tile.z = max(tile.z, is_far && other.w > gap ? other.w : 0.0);
        }
    }
    for (int i = 0; i < 9; ++i) {
        ivec2 neighbor = clamp(here + ivec2(i % 3, i / 3) - 1, ivec2(0), focus.tiles.xy - 1);
        float far = texelFetch(own_tiles, neighbor, 0).z;
        tile.w = max(tile.w, coarse_weight(far) > 0.0 ? far : 0.0);
        slight.y = max(slight.y, is_behind ? texelFetch(own_small, neighbor, 0).y : 0.0);
    }
}
