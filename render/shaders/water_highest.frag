// Height of the highest surface in each tile of kHighestTile pixels, so that rays above water skip what lies below it and
// empty sky (lib/water_tracing.glsl).
#version 450
#include "lib/view.glsl"
#include "water_gpu.h"

layout(binding = 26) uniform sampler2D behind_distance;  // water_behind.frag

layout(location = 0) out float highest;  // [m]; -kNoHeight: there is nothing

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * kHighestTile;
    ivec2 end = min(first + kHighestTile, textureSize(behind_distance, 0));
    highest = -kNoHeight;
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            float seen = texelFetch(behind_distance, ivec2(x, y), 0).r;
            float height = view.camera_ws.y + view_ray(vec2(x, y) + 0.5).y * seen;
            highest = max(highest, seen > 0.0 ? height : -kNoHeight);
        }
    }
}
