// Luminance of a quarter of the picture, far and near, each with its share: what highlights are compared with.
#version 450
#include "lib/focus.glsl"

layout(binding = 0) uniform sampler2D far_light;
layout(binding = 1) uniform sampler2D near_light;

layout(location = 0) out vec4 luminance;

void main() {
    vec2 uv = 2.0 * gl_FragCoord.xy / focus.size.zw;
    vec4 far = texture(far_light, uv);
    vec4 near = texture(near_light, uv);
    luminance = vec4(luminance_of(far.rgb), far.a, luminance_of(near.rgb), near.a);
}
