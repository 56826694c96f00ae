// What of a tile is out of focus: widest radius [px] of its near circles that are gathered finely, and coarsely; of its
// far ones. Apart from that, of small circles before and behind the focus, and of far ones that are gathered finely.
#version 450
#include "lib/focus.glsl"

layout(binding = 1) uniform sampler2D scene_depth;

layout(location = 0) out vec4 tile;
layout(location = 1) out vec4 small;

void main() {
    vec2 first = vec2(ivec2(gl_FragCoord.xy) * kFocusTile + 1);
    vec3 widest = vec3(0.0);
    small = vec4(0.0);
    for (int y = 0; y < kFocusTile; y += 2) {
        for (int x = 0; x < kFocusTile; x += 2) {
            vec4 depths = textureGather(scene_depth, (first + vec2(x, y)) / focus.size.xy);
            for (int i = 0; i < 4; ++i) {
                float diameter = circle(depths[i]);
                float radius = 0.5 * abs(diameter);
                bool is_large = 2.0 * radius > kSharpest;
                bool is_near = diameter < 0.0;
                widest = max(
                    widest,
                    vec3(
                        is_large && is_near && coarse_share(radius) < 1.0 ? radius : 0.0,
                        is_large && is_near && coarse_share(radius) > 0.0 ? radius : 0.0,
                        is_large && !is_near ? radius : 0.0));
                bool is_small = 2.0 * radius > kLeastCircle && 2.0 * radius < kBlurriest;
                float fine_far = is_large && !is_near && coarse_share(radius) < 1.0 ? radius : 0.0;
                vec2 its_small = is_small ? (is_near ? vec2(radius, 0.0) : vec2(0.0, radius)) : vec2(0.0);
                small = max(small, vec4(its_small, fine_far, 0.0));
            }
        }
    }
    tile = vec4(widest, 0.0);
}
