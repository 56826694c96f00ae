// Downsamples the depth: of each 2 x 2 pixels the depth at their center if they are on one surface, else the nearest or
// the farthest in a checkerboard (render/particles/particle_layer.h).
#version 450
#include "particle_gpu.h"

layout(binding = kParticleDepthUnit) uniform sampler2D scene_depth;

// Depths about a corner of four pixels: upper left, upper right, lower right, lower left.
vec4 depths_about(ivec2 corner) {
    return textureGather(scene_depth, vec2(corner) / vec2(textureSize(scene_depth, 0)));
}

// Whether the depth changes from b to c about as much as before and after. Depths are near / distance, which is linear
// in the image on planes.
bool is_smooth(float a, float b, float c, float d) {
    return abs(c - b) <= 2.0 * min(abs(b - a), abs(d - c)) + 0.01 * min(b, c);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 first = 2 * at;
    vec4 left = depths_about(first + ivec2(0, 1));
    vec4 right = depths_about(first + ivec2(2, 1));
    vec4 below = depths_about(first + ivec2(1, 0));
    vec4 above = depths_about(first + ivec2(1, 2));
    vec4 four = vec4(left.zy, right.wx);  // lower left, upper left, lower right, upper right
    bool smooth_rows = is_smooth(left.w, four.x, four.z, right.z) && is_smooth(left.x, four.y, four.w, right.y);
    bool smooth_columns = is_smooth(below.w, four.x, four.y, above.x) && is_smooth(below.z, four.z, four.w, above.y);
    float nearest = max(max(four.x, four.y), max(four.z, four.w));
    float farthest = min(min(four.x, four.y), min(four.z, four.w));
    gl_FragDepth = smooth_rows && smooth_columns ? dot(four, vec4(0.25))
                   : ((at.x + at.y) & 1) == 0    ? nearest
                                                 : farthest;
}
