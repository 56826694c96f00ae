// Luminance at quarter resolution, with its weight: the reference for detecting highlights.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusNearLightUnit) uniform sampler2D near_light;
layout(binding = kFocusNearWideUnit) uniform sampler2D near_wide;
layout(binding = kFocusBehindNearUnit) uniform sampler2D behind_near;

layout(location = 0) out vec2 luminance;

void main() {
    vec2 uv = 2.0 * gl_FragCoord.xy / focus.size.zw;
    vec4 all = texture(near_light, uv) + texture(near_wide, uv) + texture(behind_near, uv);
    luminance = vec2(luminance_of(all.rgb), all.a);
}
