// Depth of field from mip levels: each pixel the mean of a square as wide as its own circle (post.dof-mip).
// Techniques: post.dof-mip
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusRadianceUnit) uniform sampler2D scene_radiance;  // with mip levels
layout(binding = kFocusDepthUnit) uniform sampler2D scene_depth;

layout(location = 0) out vec4 color;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    float diameter = abs(circle(texelFetch(scene_depth, here, 0).r));
    float level = log2(max(diameter, 1.0));
    color = level > 0.0 ? textureLod(scene_radiance, gl_FragCoord.xy / focus.size.xy, level)
                        : texelFetch(scene_radiance, here, 0);
}
