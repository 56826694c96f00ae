// Blinn maps (fakephong.blinn-texture): a layer per exponent n of (1 - x^2 - y^2)^(n / 2) over the unit disc, which is
// (N.H)^n where (x, y) is N projected along H, and N.L where n = 1. Texels at the edge are 0, so that lookups beyond
// the disc return 0.
// Techniques: fakephong.blinn-texture
#version 450
#include "highlight_gpu.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kHighlightRecordsUnit) uniform samplerBuffer layers;  // w: exponent n
layout(binding = kHighlightMapsImage, r16f) writeonly uniform image2DArray maps;

void main() {
    ivec2 size = imageSize(maps).xy;
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    vec2 at = 2.0 * (vec2(texel) + 0.5) / vec2(size) - 1.0;
    float squared = 1.0 - dot(at, at);
    bool inside = squared > 1e-12 && all(greaterThan(texel, ivec2(0))) && all(lessThan(texel, size - 1));
    float exponent = texelFetch(layers, int(gl_WorkGroupID.z)).w;
    imageStore(maps, ivec3(gl_GlobalInvocationID), vec4(inside ? pow(squared, 0.5 * exponent) : 0.0));
}
