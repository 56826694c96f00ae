// Height of the highest surface in each tile of kHighestTile pixels, so that rays above water skip the surfaces below
// it and empty sky (lib/water_tracing.glsl).
#version 450
#include "lib/view.glsl"
#include "water_gpu.h"

layout(binding = kBehindWaterDepthUnit) uniform sampler2D behind_depth;  // without the water

layout(location = 0) out float highest;  // [m]; -kNoHeight: there is nothing

void main() {
    ivec2 size = textureSize(behind_depth, 0);
    ivec2 first = ivec2(gl_FragCoord.xy) * kHighestTile;
    ivec2 end = min(first + kHighestTile, size);
    highest = -kNoHeight;
    for (int y = first.y; y < end.y; y += 2) {
        for (int x = first.x; x < end.x; x += 2) {
            vec2 corner = vec2(min(ivec2(x, y) + 1, max(end - 1, 1)));  // of four pixels
            vec4 depth = textureGather(behind_depth, corner / vec2(size));
            vec4 upward = vec4(
                view_ray(corner + vec2(-0.5, 0.5)).y, view_ray(corner + 0.5).y, view_ray(corner + vec2(0.5, -0.5)).y,
                view_ray(corner - 0.5).y);
            vec4 height = view.camera_ws.y + upward * (view.camera_ws.w / max(depth, 1e-20));
            height = mix(vec4(-kNoHeight), height, greaterThan(depth, vec4(0.0)));
            highest = max(highest, max(max(height.x, height.y), max(height.z, height.w)));
        }
    }
}
