// Neighbor max: the longest motion of the tiles from which it may extend into each tile, and the longest in a different
// direction, for objects that cross.
//   xy  longest [px]
//   zw  the other; equal to xy for uniform motion in the neighborhood; 0 if there is none
// Techniques: post.motion-blur-reconstruct
#version 450
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D tiles;

uniform int side;    // of a tile [px]
uniform int radius;  // of the neighborhood [tiles]

layout(location = 0) out vec4 neighbor;

const float kDiagonal = 1.4142136;
const float kAlike = 0.12;   // invisible differences, as a fraction of the motion; by eye
const float kAlikePx = 0.3;  // [px]

// Whether a tile that lies `offset` [px] away and moves by +-motion touches this one.
bool touches(vec2 offset, vec2 motion) {
    float len = length(motion);
    vec2 direction = motion / max(len, 1e-6);
    float margin = kDiagonal * float(side);
    return abs(dot(offset, direction)) <= len + margin
           && abs(offset.x * direction.y - offset.y * direction.x) <= margin;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(tiles, 0) - 1;
    ivec2 low = max(here - radius, ivec2(0));
    ivec2 high = min(here + radius, last);
    vec2 longest = vec2(0.0);
    float longest_squared = 0.0;
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            vec2 motion = texelFetch(tiles, ivec2(x, y), 0).xy;
            float squared = dot(motion, motion);
            if (squared > longest_squared && touches(vec2(x - here.x, y - here.y) * float(side), motion)) {
                longest = motion;
                longest_squared = squared;
            }
        }
    }
    vec2 other = vec2(0.0);
    float max_across = 0.25 * longest_squared;  // sine of 15 degrees at equal length
    float apart = 0.0;
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            vec3 tile = texelFetch(tiles, ivec2(x, y), 0).xyz;
            vec2 offset = vec2(x - here.x, y - here.y) * float(side);
            // Slow motions touch this tile only from adjacent tiles, but matter there.
            if (touches(offset, longest) || touches(offset, tile.xy)) {
                apart = max(apart, distance(tile.xy, longest) + tile.z);
                float across = abs(longest.x * tile.y - longest.y * tile.x);
                if (across > max_across && touches(offset, tile.xy)) {
                    max_across = across;
                    other = tile.xy;
                }
            }
        }
    }
    bool alike = apart <= kAlike * sqrt(longest_squared) + kAlikePx;
    neighbor = vec4(longest, alike ? longest : other);
}
