// Beside the highest surface in each tile (water_highest.frag), the highest one in it and all tiles above it, so that rays
// that go up in the image cross a column at once (lib/water_tracing.glsl).
#version 450
#include "water_gpu.h"

layout(binding = kColumnSourceUnit) uniform sampler2D highest_surfaces;  // water_highest.frag

layout(location = 0) out vec2 highest;  // [m]

void main() {
    ivec2 tile = ivec2(gl_FragCoord.xy);
    highest = texelFetch(highest_surfaces, tile, 0).rr;
    for (int y = tile.y + 1; y < textureSize(highest_surfaces, 0).y; ++y) {
        highest.g = max(highest.g, texelFetch(highest_surfaces, ivec2(tile.x, y), 0).r);
    }
}
