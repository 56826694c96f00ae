// Luminance at quarter resolution, with its weight: highlights are detected against it.
#version 450
#include "lib/depth_of_field.glsl"

layout(binding = 0) uniform sampler2D near_light;
layout(binding = 1) uniform sampler2D near_wide;
layout(binding = 2) uniform sampler2D behind_near;

layout(location = 0) out vec2 luminance;

void main() {
    vec2 uv = 2.0 * gl_FragCoord.xy / focus.size.zw;
    vec4 all = texture(near_light, uv) + texture(near_wide, uv) + texture(behind_near, uv);
    luminance = vec2(luminance_of(all.rgb), all.a);
}
