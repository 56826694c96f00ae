// Fog in front of surfaces and the sky, premultiplied.
#version 450
#include "lib/view.glsl"
#include "lib/height_fog.glsl"
#include "fog_gpu.h"

layout(binding = kFogDepthUnit) uniform sampler2D scene_depth;

layout(location = 0) out vec4 radiance;

const float kInfiniteDistance = 1e6;  // [m]

void main() {
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec3 ray = view_ray(gl_FragCoord.xy);
    float path = depth > 0.0 ? view_distance(depth) * length(ray) - view.orthographic.x : kInfiniteDistance;
    radiance = fog_along(normalize(ray), path);
}
