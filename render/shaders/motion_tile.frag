// Tile max: the longest motion in each tile, and the spread of the others. Two passes, along x and along y.
//   xy  longest motion [px]
//   z   largest difference of another motion from it [px]
// Techniques: post.motion-blur-reconstruct
#version 450
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D source;

uniform ivec2 along;  // (1, 0), (0, 1)
uniform int side;     // of a tile [texels of the source]
uniform int first;    // 1: the source is that of motion_pack.frag, whose z has another meaning

layout(location = 0) out vec4 tile;

void main() {
    ivec2 last = textureSize(source, 0) - 1;
    ivec2 begin = ivec2(gl_FragCoord.xy) * mix(ivec2(1), ivec2(side), equal(along, ivec2(1)));
    vec2 longest = vec2(0.0);
    float longest_squared = -1.0;
    for (int i = 0; i < side; ++i) {
        vec2 motion = texelFetch(source, min(begin + i * along, last), 0).xy;
        float squared = dot(motion, motion);
        if (squared > longest_squared) {
            longest = motion;
            longest_squared = squared;
        }
    }
    float apart = 0.0;
    for (int i = 0; i < side; ++i) {
        vec4 texel = texelFetch(source, min(begin + i * along, last), 0);
        apart = max(apart, distance(texel.xy, longest) + (first == 1 ? 0.0 : texel.z));
    }
    tile = vec4(longest, apart, 0.0);
}
