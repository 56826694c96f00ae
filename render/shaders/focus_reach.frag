// What is to be done in a tile: widest radius [px] of the near circles that reach it, fine and coarse; if anything is
// far in it, of the fine far circles that reach it, or a little; of small ones that reach over others, likewise.
#version 450
#include "lib/focus.glsl"

layout(binding = 0) uniform sampler2D own_tiles;
layout(binding = 1) uniform sampler2D own_small;

layout(location = 0) out vec4 tile;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    tile = texelFetch(own_tiles, here, 0);
    bool is_far = tile.z > 0.0;
    tile.z = is_far ? 0.25 : 0.0;
    tile.w = texelFetch(own_small, here, 0).y > 0.0 ? 0.25 : 0.0;
    int most = focus.tiles.z;
    for (int y = -most; y <= most; ++y) {
        for (int x = -most; x <= most; ++x) {
            ivec2 there = clamp(here + ivec2(x, y), ivec2(0), focus.tiles.xy - 1);
            vec4 other = texelFetch(own_tiles, there, 0);
            float gap = length(vec2(max(abs(ivec2(x, y)) - 1, ivec2(0)) * kFocusTile));
            tile.x = max(tile.x, other.x > gap ? other.x : 0.0);
            tile.y = max(tile.y, other.y > gap ? other.y : 0.0);
            vec4 small = max(abs(x), abs(y)) <= 1 ? texelFetch(own_small, there, 0) : vec4(0.0);
            tile.z = max(tile.z, is_far && small.z > gap ? small.z : 0.0);
            tile.w = max(tile.w, max(small.x, is_far ? small.y : 0.0));
        }
    }
}
