// Height of the highest surface in each tile of kHighestTile pixels, so that rays above water skip what lies below it and
// empty sky (lib/water_tracing.glsl).
#version 450
#include "lib/view.glsl"
#include "water_gpu.h"

layout(binding = 26) uniform sampler2D behind_depth;  // without the water

layout(location = 0) out float highest;  // [m]; -kNoHeight: there is nothing

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * kHighestTile;
    ivec2 end = min(first + kHighestTile, textureSize(behind_depth, 0));
    highest = -kNoHeight;
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            float depth = texelFetch(behind_depth, ivec2(x, y), 0).r;
            float height = view.camera_ws.y + view_ray(vec2(x, y) + 0.5).y * view_distance(max(depth, 1e-20));
            highest = max(highest, depth > 0.0 ? height : -kNoHeight);
        }
    }
}
