// Distance along the view axis [m] and its square, whose mip levels are means of both. Background is far away.
#version 450
#include "lib/view.glsl"

layout(binding = 6) uniform sampler2D scene_depth;

layout(location = 0) out vec2 moments;

const float kFar = 1e4;

void main() {
    float z = min(view_distance(max(texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r, 1e-12)), kFar);
    moments = vec2(z, z * z);
}
