// The scene without water: its radiance and, in w, its distance along the view axis [m], 0 where there is no surface.
#version 450
#include "lib/view.glsl"
#include "fullscreen_gpu.h"
#include "water_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D radiance;
layout(binding = kWaterCopyDepthUnit) uniform sampler2D depth;

layout(location = 0) out vec4 scene;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float d = texelFetch(depth, pixel, 0).r;
    scene = vec4(texelFetch(radiance, pixel, 0).rgb, d > 0.0 ? view_distance(d) : 0.0);
}
