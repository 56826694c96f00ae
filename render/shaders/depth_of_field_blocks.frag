// Widest out-of-focus radii [px] in a block: of near circles gathered finely, of those gathered coarsely; of all far
// circles, of those gathered finely. Separately, of small circles in front of and behind the focus.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusDepthUnit) uniform sampler2D scene_depth;

layout(location = 0) out vec4 block;
layout(location = 1) out vec2 small;

void main() {
    vec2 first = vec2(ivec2(gl_FragCoord.xy) * kFocusBlock + 1);
    block = vec4(0.0);
    small = vec2(0.0);
    for (int quad = 0; quad < 4; ++quad) {
        vec2 corner = first + vec2(quad & 1, quad >> 1) * 2.0;
        vec4 depths = textureGather(scene_depth, corner / focus.size.xy);
        for (int i = 0; i < 4; ++i) {
            float diameter = circle(depths[i]);
            float radius = 0.5 * abs(diameter);
            vec2 side = diameter < 0.0 ? vec2(radius, 0.0) : vec2(0.0, radius);
            float fine = coarse_weight(radius) < 1.0 ? 1.0 : 0.0;
            float coarse = coarse_weight(radius) > 0.0 ? 1.0 : 0.0;
            vec2 large = 2.0 * radius > kFullResDiameter ? side : vec2(0.0);
            block = max(block, vec4(large.x * fine, large.x * coarse, large.y, large.y * fine));
            bool is_small = 2.0 * radius > kMinCircle && 2.0 * radius < kHalfResDiameter;
            small = max(small, is_small ? side : vec2(0.0));
        }
    }
}
