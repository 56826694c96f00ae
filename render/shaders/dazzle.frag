// Mixes the image with the color of each dazzling point, weighted by its visibility (dazzle_pass.h).
// Techniques: engine.obfuscating-point
#version 450
#include "dazzle_gpu.h"
#include "disk_visibility_gpu.h"
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(binding = kVisibilityUnit) uniform sampler2D visibility;  // of each point
layout(binding = kDazzlePointsUnit) uniform samplerBuffer points;  // DazzlePoint

uniform int count;

layout(location = 0) out vec4 radiance;

void main() {
    radiance = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
    for (int i = 0; i < count; ++i) {
        vec4 point = texelFetch(points, i);
        radiance.rgb = mix(radiance.rgb, point.rgb, point.w * texelFetch(visibility, ivec2(i, 0), 0).r);
    }
}
