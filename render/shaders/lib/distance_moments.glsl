// Distance along the view axis [m] and its square, whose mip levels are means of both. Background is far away.

#include "lib/view.glsl"
#include "gbuffer_gpu.h"

layout(binding = kDepthUnit) uniform sampler2D scene_depth;

const float kFar = 1e4;

vec2 distance_moments(ivec2 pixel) {
    float z = min(view_distance(max(texelFetch(scene_depth, pixel, 0).r, 1e-12)), kFar);
    return vec2(z, z * z);
}
