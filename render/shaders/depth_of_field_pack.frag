// Packs the radius of the circle of each pixel with its radiance, so that later passes need one fetch.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusRadianceUnit) uniform sampler2D scene_radiance;
layout(binding = kFocusDepthUnit) uniform sampler2D scene_depth;

layout(location = 0) out vec4 pixel;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec4 light = finite_light(texelFetch(scene_radiance, here, 0));
    float radius = 0.5 * circle(texelFetch(scene_depth, here, 0).r);
    pixel = vec4(light.rgb, light.a > 0.0 ? radius : kUnknown);
}
